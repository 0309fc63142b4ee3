// Scenes: YAML, includes, trackers, parameters and the keys of a scene.

#include "read_scene.hpp"
#include "session/scene_file.hpp"
#include "target.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(scene, "yaml") {
  const std::filesystem::path folder = scratch() / "scene";
  static const bool written = [&] {
    std::filesystem::create_directories(folder);
    test::write_other_scene(folder);
    return true;
  }();
  require(written, "other scenes are there");
  const bool read = test::read_scene(bytes, folder);
  attempt([&] { load_scene(folder / "scene.yaml", {}); });
  if (!read) throw ConfigError("refused");
}

}  // namespace hypotrack::fuzz
