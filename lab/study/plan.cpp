#include "lab/study/plan.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <utility>

#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "lab/study/hash.hpp"

namespace hypotrack::study::internal {
namespace {

constexpr std::size_t kMaxRuns = 100'000;

/// The content of a scene's file and, where it includes other files, its resolved content.
std::string read_scene_text(const StudyScene& scene) {
  const std::optional<std::string> text = read_whole(scene.file);
  if (!text)
    throw ConfigError(fmt::format("{}: scene '{}': cannot read {}", scene.where, scene.name,
                                  scene.file.string()));
  try {
    const std::string written = ConfigNode::load(scene.file).to_yaml();
    const std::string whole = ConfigNode::load_scene(scene.file).to_yaml();
    return whole == written ? *text : *text + whole;
  } catch (const ConfigError& error) {
    throw ConfigError(fmt::format("{}: {}: {}", scene.where, scene.name, error.what()));
  }
}

std::vector<Cell> make_cells(const Study& study) {
  std::size_t count = study.scenes.size();
  for (const Axis& axis : study.axes) {
    count *= axis.choices.size();
    if (count * study.seeds.size() > kMaxRuns) break;
  }
  if (count * study.seeds.size() > kMaxRuns)
    throw ConfigError(fmt::format("the study '{}' has more than {} runs; leave out some values",
                                  study.title, kMaxRuns));
  std::vector<Cell> cells;
  cells.reserve(count);
  for (std::size_t index = 0; index < count; ++index) {
    Cell cell{0, std::vector<std::size_t>(study.axes.size()), std::nullopt};
    std::size_t rest = index;
    for (std::size_t axis = study.axes.size(); axis-- > 0;) {
      cell.choices[axis] = rest % study.axes[axis].choices.size();
      rest /= study.axes[axis].choices.size();
    }
    cell.scene = rest;
    cells.push_back(std::move(cell));
  }
  return cells;
}

/// Finds out what the runs of each cell redraw. Cells with the same source share the work.
void find_noise(Plan& plan) {
  std::map<std::string, std::optional<NoiseSeed>> known;
  for (Cell& cell : plan.cells) {
    const std::vector<Change> changes = plan.changes_of(cell);
    std::string source = plan.scene_of(cell).file.string();
    for (const Change& change : changes)
      if (is_recorded(change)) source += "\n" + change.meaning();
    const auto [at, is_new] = known.try_emplace(std::move(source));
    if (is_new) at->second = find_noise_seed(plan.scene_of(cell), changes);
    cell.noise = at->second;
  }
}

std::string run_id(const Plan& plan, const PlannedRun& run) {
  const Cell& cell = plan.cells[run.cell];
  Hash hash;
  hash.add(plan.scene_texts[cell.scene]);
  for (const Change& change : plan.changes_of(run)) hash.add(change.meaning());
  for (std::size_t axis = 0; axis < plan.study.axes.size(); ++axis) {
    hash.add(plan.study.axes[axis].name);
    hash.add(plan.choice_of(cell, axis).label);
  }
  hash.add(plan.study.frames ? fmt::format("{}", *plan.study.frames) : "all");
  if (plan.study.recordings) hash.add("recordings");  // recordings may round depths
  if (plan.study.trace) hash.add("trace");            // runs without one lack files
  return fmt::format("{}_s{}_{:016x}", plan.scene_of(cell).name, run.seed, hash.value());
}

}  // namespace

std::vector<Change> Plan::changes_of(const Cell& cell) const {
  std::vector<Change> changes = scene_of(cell).changes;
  for (std::size_t axis = 0; axis < study.axes.size(); ++axis) {
    const Choice& choice = choice_of(cell, axis);
    changes.insert(changes.end(), choice.changes.begin(), choice.changes.end());
  }
  return changes;
}

std::vector<Change> Plan::changes_of(const PlannedRun& run) const {
  const Cell& cell = cells[run.cell];
  std::vector<Change> changes = changes_of(cell);
  if (!cell.noise) return changes;
  if (auto change = redrawn(*cell.noise, run.seed)) changes.push_back(*std::move(change));
  return changes;
}

std::string Plan::describe(const Cell& cell) const {
  std::string text = scene_of(cell).name;
  for (std::size_t axis = 0; axis < study.axes.size(); ++axis)
    text += fmt::format(", {} {}", study.axes[axis].name, choice_of(cell, axis).label);
  return text;
}

Plan make_plan(Study study) {
  Plan plan;
  plan.cells = make_cells(study);
  plan.study = std::move(study);
  for (const StudyScene& scene : plan.study.scenes)
    plan.scene_texts.push_back(read_scene_text(scene));
  if (plan.study.redraw == Redraw::noise) find_noise(plan);
  for (const std::int64_t seed : plan.study.seeds)
    for (std::size_t i = 0; i < plan.cells.size(); ++i) {
      plan.runs.push_back({i, seed, {}});
      plan.runs.back().id = run_id(plan, plan.runs.back());
    }
  return plan;
}

std::vector<std::size_t> runs_of(const Plan& plan, Shard shard) {
  std::vector<std::size_t> runs;
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    const std::size_t seed = i / plan.cells.size();
    if ((plan.runs[i].cell + seed) % shard.count == shard.index) runs.push_back(i);
  }
  return runs;
}

}  // namespace hypotrack::study::internal
