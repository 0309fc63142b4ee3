#include "session/scene_file.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/read_value.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"

namespace hypotrack::internal {
namespace {

/// Refuses keys that have another name today.
void refuse_old_keys(const ConfigNode& root) {
  constexpr const char* kOld = "hindsight";
  if (!root.get(kOld).defined()) return;
  throw ConfigError(fmt::format(
      "{}: found the key '{}', which is called 'smoothing.fixed_lag' now; write `smoothing: "
      "{{fixed_lag: {{...}}}}` with the same settings, or --set smoothing.fixed_lag.KEY=VALUE",
      root.where_key(kOld), kOld));
}

/// Returns whether a word names a starter that takes its file from `init.file`.
bool takes_file(const ConfigNode& from) {
  return from.scalar() == kStartFromFile || from.scalar() == kStartFromClicks;
}

}  // namespace

std::vector<ConfigNode> starter_nodes(const ConfigNode& from, const ConfigNode& written) {
  std::vector<ConfigNode> all;
  const auto add = [&](const ConfigNode& node) {
    if (node.is_map()) return all.push_back(node);
    std::array<std::pair<std::string, ConfigNode>, 3> entries;
    entries[0] = {"type", node};
    if (takes_file(node)) entries[1] = {"file", written.get("file")};
    if (node.scalar() == kStartFromFile) entries[2] = {"frame", written.get("frame")};
    all.push_back(ConfigNode::map_of(entries));
  };
  if (from.is_list()) {
    for (std::size_t i = 0; i < from.size(); ++i) add(from.at(i));
  } else if (from.scalar() == kStartAuto) {
    const ConfigNode list = ConfigNode::load(data_file("configs/starters/auto.yaml"));
    if (!list.is_list() || list.size() == 0)
      detail::fail_at(list, "expected a list of starters that look, as `- global_search`");
    for (std::size_t i = 0; i < list.size(); ++i) add(list.at(i));
  } else {
    add(from);
  }
  if (all.empty()) detail::fail_at(from, "an empty list; expected the starters to try");
  return all;
}

LoadedScene load_scene(const SceneInput& input, std::span<const std::string> overrides) {
  LoadedScene scene;
  scene.root = input.read(overrides, &scene.notes);
  if (!scene.root.is_map())
    throw ConfigError(fmt::format(
        "{}: a scene is a map with models, source, objective and optimizer", scene.root.where()));
  if (scene.root.get("scenes").defined() && !scene.root.get("models").defined())
    throw ConfigError(fmt::format(
        "{}: this is a study, no scene: it has `scenes`; `hypotrack compare` makes its runs",
        scene.root.where_key("scenes")));
  refuse_old_keys(scene.root);
  scene.file = ParamReader(scene.root).read<SceneFile>();
  if (scene.file.tracker.defined())
    throw ConfigError(
        fmt::format("{}: expected the name of a tracker file, as \"@trackers/recommended\"",
                    detail::with_path(scene.file.tracker.where(), scene.file.tracker.path())));
  const InitSettings& init = scene.file.init;
  if (init.from.is_map() && (!init.file.empty() || init.frame != 0))
    throw ConfigError(fmt::format(
        "{}: init.file and init.frame belong to `from: file`; give them within the map init.from",
        scene.root.get("init").where()));
  if (takes_file(init.from) && init.file.empty())
    throw ConfigError(fmt::format("{}: init.from is '{}' but init.file names none",
                                  scene.root.get("init").where(), init.from.scalar()));
  return scene;
}

}  // namespace hypotrack::internal
