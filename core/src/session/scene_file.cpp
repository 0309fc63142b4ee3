#include "session/scene_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/read_value.hpp"
#include "hypotrack/error.hpp"

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

/// Moves the keys of `tracker` that belong to `judge` there.
void take_former_keys(LoadedScene& scene) {
  FormerJudgeKeys& former = scene.file.tracker.former;
  const ConfigNode written = scene.root.get("tracker");
  std::vector<std::string> keys;
  std::string settings;
  if (former.evidence) keys.emplace_back("tracker.evidence");
  const auto move = [&](std::string_view key, const std::optional<double>& value) {
    if (!value) return;
    keys.push_back(fmt::format("tracker.{}", key));
    settings += fmt::format(", {}: {}", key, *value);
  };
  move("tracked_above", former.tracked_above);
  move("surely_above", former.surely_above);
  move("first_above", former.first_above);
  move("confirmed_above", former.confirmed_above);
  move("uncertain_above", former.uncertain_above);
  if (keys.empty()) return;
  const std::string judge = former.evidence.value_or(true)
                                ? fmt::format("{{type: {}{}}}", kUsualJudge, settings)
                                : std::string(kNoJudge);
  if (scene.root.get("judge").defined())
    throw ConfigError(
        fmt::format("{}: found {} beside `judge`, which has replaced it; leave it out",
                    written.where(), fmt::join(keys, ", ")));
  scene.notes.push_back(fmt::format("{}: `judge` has replaced {}; write `judge: {}`",
                                    written.where(), fmt::join(keys, ", "), judge));
  scene.file.judge = ConfigNode::parse(judge, written.where() + ": tracker").placed_at("judge");
  former = {};
}

/// Returns whether a word names a start that takes its file from `init.file`.
bool takes_file(const ConfigNode& from) {
  return from.scalar() == kStartFromFile || from.scalar() == kStartFromClicks;
}

}  // namespace

std::vector<ConfigNode> start_nodes(const ConfigNode& from, const ConfigNode& written) {
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
    for (const char* type : {"hand_landmarks", "global_search"})
      add(ConfigNode::parse(type, "the starts of auto"));
  } else {
    add(from);
  }
  if (all.empty()) detail::fail_at(from, "an empty list; expected the starts to try");
  return all;
}

LoadedScene load_scene(const std::filesystem::path& path, std::span<const std::string> overrides) {
  LoadedScene scene;
  scene.root = ConfigNode::load_scene(path, overrides);
  if (!scene.root.is_map())
    throw ConfigError(fmt::format(
        "{}: a scene is a map with models, source, objective and optimizer", scene.root.where()));
  if (scene.root.get("scenes").defined() && !scene.root.get("models").defined())
    throw ConfigError(fmt::format(
        "{}: this is a study, no scene: it has `scenes`; `hypotrack compare` makes its runs",
        path.string()));
  refuse_old_keys(scene.root);
  scene.file = ParamReader(scene.root).read<SceneFile>();
  take_former_keys(scene);
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
