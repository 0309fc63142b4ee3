#include "lab/bench/bench_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/study_file.hpp"
#include "session/scene_file.hpp"

namespace hypotrack::bench::internal {
namespace {

constexpr const char* kWays = "backend";

std::vector<std::string> assignments(const std::vector<study::Change>& changes) {
  std::vector<std::string> overrides;
  for (const study::Change& change : changes) overrides.push_back(change.assignment());
  return overrides;
}

/// Removes the axis of the configurations from the study's grid and returns them.
std::vector<Configuration> take_configurations(study::Study& study,
                                               const std::filesystem::path& table) {
  const auto axis = std::find_if(study.axes.begin(), study.axes.end(),
                                 [](const study::Axis& other) { return other.name == kWays; });
  if (axis == study.axes.end() || axis->is_key)
    throw ConfigError(
        fmt::format("{}: a table of bench needs an axis '{}' with a case for every way to track, "
                    "`grid: {{{}: {{cpu: {{evaluate.backend: cpu}}, ...}}}}`",
                    table.string(), kWays, kWays));
  std::vector<Configuration> configurations;
  for (const study::Choice& choice : axis->choices)
    configurations.push_back({choice.label, assignments(choice.changes)});
  study.axes.erase(axis);
  return configurations;
}

std::vector<Case> cases_of(const study::Study& study) {
  const study::Plan plan = study::make_plan(study);
  std::vector<Case> cases;
  for (const study::Cell& cell : plan.cells) {
    const study::StudyScene& scene = plan.scene_of(cell);
    std::string label = scene.label;
    for (std::size_t axis = 0; axis < study.axes.size(); ++axis)
      label += fmt::format(", {} {}", study.axes[axis].name, plan.choice_of(cell, axis).label);
    cases.push_back({scene.name, std::move(label), scene.file, assignments(plan.changes_of(cell)),
                     study.directory});
  }
  return cases;
}

template <class T>
std::vector<std::string> names_of(const std::vector<T>& items) {
  std::vector<std::string> names;
  for (const T& item : items)
    if (std::find(names.begin(), names.end(), item.name) == names.end()) names.push_back(item.name);
  return names;
}

/// Returns the cases of the table with a name, or a case for a scene file.
std::vector<Case> find_cases(const std::vector<Case>& table, const std::string& scene) {
  std::vector<Case> found;
  std::copy_if(table.begin(), table.end(), std::back_inserter(found),
               [&](const Case& other) { return other.name == scene; });
  if (!found.empty()) return found;
  if (!std::filesystem::exists(scene)) {
    const auto names = names_of(table);
    throw ConfigError(
        fmt::format("{}: there is no such scene file, and the table has no scene of this name{}; "
                    "its scenes are: {}",
                    scene, did_you_mean(scene, names), fmt::join(names, ", ")));
  }
  return {{scene, scene, std::filesystem::absolute(scene), {}, std::filesystem::current_path()}};
}

void keep_configurations(std::vector<Configuration>& configurations,
                         const std::vector<std::string>& kept) {
  const auto names = names_of(configurations);
  for (const std::string& name : kept)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw ConfigError(
          fmt::format("--backends {}: the table has no such case{}; its cases are: "
                      "{}",
                      name, did_you_mean(name, names), fmt::join(names, ", ")));
  if (kept.empty()) return;
  std::erase_if(configurations, [&](const Configuration& configuration) {
    return std::find(kept.begin(), kept.end(), configuration.name) == kept.end();
  });
}

}  // namespace

Plan make_plan(const Request& request) {
  study::Study study = study::load_study(request.table, request.variant);
  Plan plan{study.title, {}, take_configurations(study, request.table), study.frames};
  keep_configurations(plan.configurations, request.backends);
  const std::vector<Case> table = cases_of(study);
  if (request.scenes.empty()) plan.cases = table;
  for (const std::string& scene : request.scenes)
    for (Case& found : find_cases(table, scene)) plan.cases.push_back(std::move(found));
  for (Case& c : plan.cases) {
    c.overrides.insert(c.overrides.end(), request.set.begin(), request.set.end());
    enter_directory(c);
    load_scene(c.file, c.overrides);  // finds mistakes before anything is measured
  }
  return plan;
}

void enter_directory(const Case& c) { std::filesystem::current_path(c.directory); }

}  // namespace hypotrack::bench::internal
