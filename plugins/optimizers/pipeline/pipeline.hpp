#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/plugin/optimizer.hpp"

namespace hypotrack {

/// Dimensions that a stage moves; the others keep the values of earlier stages.
enum class Moves {
  all,
  poses,  ///< positions and rotations of models
  limbs,  ///< everything but poses
};
std::span<const std::string_view> enum_names(Moves);

/// Start of a stage.
enum class StageStart {
  best,   ///< at the best point of the stages before it
  start,  ///< at the start of the whole search
};
std::span<const std::string_view> enum_names(StageStart);

/// One optimizer in a sequence.
struct PipelineStage {
  std::string name;  ///< for messages
  std::unique_ptr<Optimizer> optimizer;
  double share = 1;       ///< of the budget, relative to the other stages' shares; > 0
  double spread = 1;      ///< factor of the region's spread for this stage; > 0
  bool fallback = false;  ///< skipped if the best cost so far is not above the usual
  Moves moves = Moves::all;
  StageStart from = StageStart::best;
};

/// Runs optimizers one after the other. The first searches from the region's start, each later one
/// from the best point so far (or from the start again), within the same bounds.
///
/// A stage gets its share of the evaluations and seconds that the stages before it left, so that
/// unused budget goes to later stages. Evaluations are rounded down; the last stage gets all that
/// are left. A stage without an evaluation is skipped. A fallback stage is skipped if the best cost
/// so far is at or below Budget::usual_cost. Every later stage spends one evaluation on its known
/// start. Stage k searches with seed_of_part(seed, k). Dimensions that a stage does not move have
/// equal bounds at its start. In a region without groups every stage moves all.
class Pipeline : public Optimizer {
 public:
  /// Throws ConfigError, naming `where`, if there are no stages.
  Pipeline(std::vector<PipelineStage> stages, std::int64_t default_evaluations,
           const std::string& where = "pipeline");

  /// Returns what any stage requires; names the first stage that needs a device.
  Requirements requirements() const override;
  std::int64_t default_evaluations() const override { return default_evaluations_; }
  /// Runs the stages. A ConfigError or DeviceError of a stage names the stage.
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  /// Returns a stage's message with its number and name.
  std::string of_stage(std::size_t stage, std::string_view what) const;
  OptimizerResult run(std::size_t stage, CostFunction& cost, const SearchRegion& region,
                      const Budget& budget, std::uint64_t seed);

  std::vector<PipelineStage> stages_;
  std::int64_t default_evaluations_;
  std::string where_;
};

}  // namespace hypotrack
