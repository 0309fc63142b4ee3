#include "pipeline.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack {
namespace {

/// Returns the region for a stage that begins at `start`.
SearchRegion region_of(const PipelineStage& stage, const SearchRegion& region,
                       const Eigen::VectorXd& start) {
  SearchRegion own = region;
  own.start = start;
  own.spread *= stage.spread;
  if (stage.moves == Moves::all) return own;
  const auto moved =
      stage.moves == Moves::poses ? SearchGroup::Kind::pose : SearchGroup::Kind::limb;
  for (const SearchGroup& group : region.groups) {
    if (group.kind == moved) continue;
    for (const int d : group.dimensions) own.lower[d] = own.upper[d] = start[d];
  }
  return own;
}

}  // namespace

std::span<const std::string_view> enum_names(Moves) {
  static constexpr std::array<std::string_view, 3> kNames{"all", "poses", "limbs"};
  return kNames;
}

std::span<const std::string_view> enum_names(StageStart) {
  static constexpr std::array<std::string_view, 2> kNames{"best", "start"};
  return kNames;
}

Pipeline::Pipeline(std::vector<PipelineStage> stages, std::int64_t default_evaluations,
                   const std::string& where)
    : stages_(std::move(stages)), default_evaluations_(default_evaluations), where_(where) {
  if (stages_.empty()) {
    throw ConfigError(where_ +
                      ": pipeline: there are no stages; expected a list like `stages: [{optimizer: "
                      "{type: pso}, share: 0.6}, {optimizer: {type: nlopt}, share: 0.4}]`");
  }
}

Requirements Pipeline::requirements() const {
  Requirements all;
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    Requirements stage = stages_[k].optimizer->requirements();
    stage.device_by = of_stage(k, stage.device_by.empty() ? "the optimizer" : stage.device_by);
    all.merge(stage);
  }
  return all;
}

std::string Pipeline::of_stage(std::size_t stage, std::string_view what) const {
  const std::string place = where_ + ": ";
  if (what.starts_with(place)) what.remove_prefix(place.size());  // do not repeat the place
  return place + "stage " + std::to_string(stage + 1) + " of " + std::to_string(stages_.size()) +
         ", " + stages_[stage].name + ": " + std::string(what);
}

OptimizerResult Pipeline::run(std::size_t stage, CostFunction& cost, const SearchRegion& region,
                              const Budget& budget, std::uint64_t seed) {
  try {
    return stages_[stage].optimizer->minimize(
        cost, region, budget, seed_of_part(seed, static_cast<std::uint32_t>(stage)));
  } catch (const ConfigError& error) {
    throw ConfigError(of_stage(stage, error.what()));
  } catch (const DeviceError& error) {
    throw DeviceError(of_stage(stage, error.what()));
  }
}

OptimizerResult Pipeline::minimize(CostFunction& cost, const SearchRegion& region,
                                   const Budget& budget, std::uint64_t seed) {
  check_search(cost, region, budget);
  const Deadline deadline(budget.seconds);
  double shares = 0;
  for (const PipelineStage& stage : stages_) shares += stage.share;

  OptimizerResult best;
  best.point = region.start;
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    const std::int64_t left = budget.evaluations - best.evaluations;
    if (left == 0 || (best.evaluations > 0 && deadline.passed())) break;
    const bool needed =
        !stages_[k].fallback || best.evaluations == 0 || best.cost > budget.usual_cost;
    const double share = k + 1 < stages_.size() ? stages_[k].share / shares : 1;
    shares -= stages_[k].share;
    const auto evaluations =
        std::min(left, static_cast<std::int64_t>(share * static_cast<double>(left)));
    if (evaluations == 0 || !needed) continue;

    const Budget part{evaluations, std::max(0.0, share * deadline.left()), budget.usual_cost};
    const Eigen::VectorXd& from = stages_[k].from == StageStart::best ? best.point : region.start;
    const OptimizerResult found = run(k, cost, region_of(stages_[k], region, from), part, seed);
    const std::int64_t all = best.evaluations + found.evaluations;
    if (best.evaluations == 0 || found.cost < best.cost) best = found;
    best.evaluations = all;
  }
  return best;
}

}  // namespace hypotrack
