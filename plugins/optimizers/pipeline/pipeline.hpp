#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/optimizer.hpp"

namespace hypotrack {

/// What of a scene a stage moves; the rest stays where the stages before it left it.
enum class Moves {
  all,
  poses,  ///< where models are and how they are turned
  limbs,  ///< what is not a pose
};
std::span<const std::string_view> enum_names(Moves);

/// Where a stage begins.
enum class StageStart {
  best,   ///< at the best point of the stages before it
  start,  ///< where the whole search began
};
std::span<const std::string_view> enum_names(StageStart);

/// One optimizer of several that take turns.
struct PipelineStage {
  std::string name;  ///< for messages
  std::unique_ptr<Optimizer> optimizer;
  double share = 1;     ///< of the budget, in proportion to the other stages'; > 0
  double spread = 1;    ///< factor of the region's spread for this stage; > 0
  bool rescue = false;  ///< passed over where the best so far costs no more than usual
  Moves moves = Moves::all;
  StageStart from = StageStart::best;
};

/// Optimizers one after the other: the first searches from the region's start, each later one from
/// the best point so far (or from the region's start again), within the same bounds.
///
/// A stage gets its share of what the stages before it left of the budget, evaluations (rounded
/// down, the last stage all that is left) and seconds alike, so that what one does not use goes to
/// those after it. A stage without an evaluation of its own is passed over, and so is one that is a
/// rescue where the best of the stages before it is at or below Budget::usual_cost. Each evaluates
/// where it begins, so every later stage spends one evaluation on a point that is known. Stage k
/// searches with seed_of_part(seed, k). What a stage does not move has bounds that meet at its
/// start; in a region without groups every stage moves all.
class Pipeline : public Optimizer {
 public:
  /// Throws ConfigError, naming `where`, without stages.
  Pipeline(std::vector<PipelineStage> stages, std::int64_t default_evaluations,
           const std::string& where = "pipeline");

  bool needs_residuals() const override;         ///< whether a stage does
  Linearization linearization() const override;  ///< the most that a stage wants
  std::string needs_device() const override;     ///< of the first stage that does
  std::int64_t default_evaluations() const override { return default_evaluations_; }
  /// A ConfigError or DeviceError of a stage names the stage.
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  /// What a stage says, with its number and name.
  std::string of_stage(std::size_t stage, std::string_view what) const;
  OptimizerResult run(std::size_t stage, CostFunction& cost, const SearchRegion& region,
                      const Budget& budget, std::uint64_t seed);

  std::vector<PipelineStage> stages_;
  std::int64_t default_evaluations_;
  std::string where_;
};

}  // namespace hypotrack
