#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// A batch of hypotheses from the host: uploads states and downloads costs.
class HostBatch {
 public:
  /// Takes states (DxN) for upload(); discards the costs of an earlier batch. Each state gets
  /// `cost_sets` costs: N of the first set, then of the next.
  void take(const Eigen::MatrixXd& states, int cost_sets = 1);
  /// Enqueues the upload of the states.
  void upload(Stream stream);
  void upload(const Eigen::MatrixXd& states, Stream stream) {
    take(states);
    upload(stream);
  }
  /// Returns a number that changes whenever upload() or download() would use other memory.
  std::uint64_t revision() const { return revision_; }
  /// Returns the batch on the device; its points are normalised states.
  BatchLayout layout() const;
  /// Enqueues the download of `count` costs, starting at number `first`.
  void download(Eigen::Index first, Eigen::Index count, Stream stream);
  /// Adds up the sets of downloaded costs; the stream must have been waited for. Throws by
  /// refuse_cost(), naming the first of `terms`, if a cost is NaN.
  void read(Eigen::Ref<Eigen::VectorXd> costs, const std::vector<ObjectiveTerm>& terms) const;

 private:
  Eigen::Index count_ = 0;
  int cost_sets_ = 1;
  std::size_t numbers_ = 0;  // of the states
  std::uint64_t revision_ = 0;
  DeviceBuffer<double> points_, costs_;
  PinnedBuffer<double> points_staging_, costs_staging_;
};

}  // namespace internal
}  // namespace hypotrack::cuda
