#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// A batch of hypotheses from the host: uploads states and downloads costs.
class HostBatch {
 public:
  /// Enqueues the upload of states (DxN); discards the costs of an earlier batch.
  void upload(const Eigen::MatrixXd& states, Stream stream);
  /// Returns the batch on the device; its points are normalised states.
  BatchLayout layout() const;
  /// Enqueues the download of `count` costs, starting at number `first`.
  void download(Eigen::Index first, Eigen::Index count, Stream stream);
  /// Copies the downloaded costs; the stream must have been waited for. Throws by refuse_cost(),
  /// naming the first of `terms`, if a cost is NaN.
  void read(Eigen::Ref<Eigen::VectorXd> costs, const std::vector<ObjectiveTerm>& terms) const;

 private:
  Eigen::Index count_ = 0;
  DeviceBuffer<double> points_, costs_;
  PinnedBuffer<double> points_staging_, costs_staging_;
};

}  // namespace internal
}  // namespace hypotrack::cuda
