#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "hypotrack/plugin/optimizer.hpp"
#include "pso_params.hpp"

namespace hypotrack {

/// Pso on the GPU (plugins/optimizers/pso: the algorithm, its random numbers and its budget).
/// Points and costs stay in GPU memory: per frame only the search region is uploaded and the best
/// point downloaded. Searches in double precision, like Pso. The searches are equal up to the
/// rounding of the initial samples' logarithm and cosine.
///
/// A search is one kernel if the cost has one for it (DeviceCost::enqueue_search()). Otherwise it
/// is captured into a CUDA graph, which is launched again for every frame as long as particles,
/// budget, dimension and the cost's revision stay the same. A search with a time limit, or of more
/// than 1,024 generations, is enqueued generation by generation instead.
///
/// Takes 8 (4 D + 15) bytes of GPU memory per particle in D dimensions: 984 bytes in 27. That is
/// 1.0 GiB for the largest number of particles, 2^20. The evaluation needs more.
class PsoCuda : public Optimizer {
 public:
  /// `where` is the place of the parameters in messages. Throws ConfigError unless cognitive +
  /// social > 4, and DeviceError in a build without CUDA. Does not need a GPU yet.
  explicit PsoCuda(const PsoParams& params, const std::string& where = "pso_cuda");
  ~PsoCuda() override;

  Requirements requirements() const override;
  std::int64_t default_evaluations() const override;
  /// Searches the region. Throws DeviceError if the cost has no device().
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
