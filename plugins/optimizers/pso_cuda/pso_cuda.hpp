#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "hypotrack/optimizer.hpp"
#include "pso_params.hpp"

namespace hypotrack {

/// The swarm of Pso (plugins/optimizers/pso: the algorithm, its numbers and its budget) in GPU
/// memory. Points and costs never leave it: per frame the search region goes up, the best point
/// comes down. Searches in double precision, like Pso; they take the same way but for the rounding
/// of the initial sample's logarithm and cosine.
///
/// A search is one kernel if the cost has one for it (DeviceCost::enqueue_search()). Else it is
/// captured into a CUDA graph that is launched again, frame after frame, as long as particles,
/// budget, dimension and the cost's revision stay the same. A search with a budget of time, or of
/// more than 1,024 generations, is enqueued generation by generation instead.
///
/// Takes 8 (4 D + 15) bytes of GPU memory per particle in D dimensions: 984 bytes in 27, so 1.0 GiB
/// for the most particles there can be, 2^20; the evaluation needs more.
class PsoCuda : public Optimizer {
 public:
  /// `where` is the place of the parameters in messages. Throws ConfigError unless
  /// cognitive + social > 4, and DeviceError in a build without CUDA. Needs no GPU yet.
  explicit PsoCuda(const PsoParams& params, const std::string& where = "pso_cuda");
  ~PsoCuda() override;

  std::string needs_device() const override;
  std::int64_t default_evaluations() const override;
  /// Throws DeviceError where the cost has no device().
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  struct OnDevice;

  PsoParams params_;
  Constriction constriction_;
  std::string where_;
  std::unique_ptr<OnDevice> on_device_;
};

}  // namespace hypotrack
