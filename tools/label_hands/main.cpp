// hypotrack_label_hands: labels the hands of a recording by a learned detector, so that trackers
// can be judged on it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "base/standard_streams.hpp"
#include "hand_labeler.hpp"
#include "session/opened_scene.hpp"

namespace {

using namespace hypotrack;

void label_scene(const std::filesystem::path& scene, const std::vector<std::string>& overrides,
                 const std::filesystem::path& out) {
  PluginLoader plugins(std::vector<std::filesystem::path>{});
  const OpenedScene session = open_source(scene, overrides, plugins);
  const Scene& models = *session.scene;
  hands::HandLabeler labeler(models, session.source->cameras());
  std::vector<LandmarkRow> rows;
  const auto write = [&] { write_landmarks(out, models.landmark_names(), rows); };
  write();  // finds an unwritable file before anything is detected
  while (const auto frame = session.source->next()) rows.push_back(labeler.label(*frame));
  write();
  for (std::size_t m = 0; m < models.items().size(); ++m)
    if (labeler.is_hand(m))
      fmt::print("{}: labelled in {} of {} frames\n", models.items()[m].name, labeler.labelled()[m],
                 rows.size());
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();
  std::filesystem::path scene, out;
  std::vector<std::string> set;
  CLI::App app("Labels the hands of a recording by a learned detector, in both views.",
               "hypotrack_label_hands");
  app.add_option("scene", scene, "Scene file (YAML)")->required();
  app.add_option("--out", out,
                 "Table of landmarks to write, which truth_landmarks of a source reads")
      ->required();
  app.add_option("--set", set, "Change a key of the scene: key.path=value (may be repeated)")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->take_all();
  CLI11_PARSE(app, argc, argv);
  try {
    label_scene(scene, set, out);
    return 0;
  } catch (const std::exception& e) {
    fmt::print(stderr, "hypotrack_label_hands: {}\n", e.what());
    return 1;
  }
}
