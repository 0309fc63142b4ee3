#pragma once

#include <Eigen/Core>
#include <vector>

#include "cost/evaluator.hpp"
#include "hypotrack/cuda/runtime.cuh"

namespace hypotrack::cuda {

/// A batch of hypotheses that comes from the host: states go up, costs come down.
class HostBatch {
 public:
  /// Enqueues the upload of states (DxN). Costs of an earlier batch are lost.
  void upload(const Eigen::MatrixXd& states, Stream stream);
  /// The batch on the device: normalised states.
  BatchLayout layout() const;
  /// Enqueues the download of `count` costs from number `first` on.
  void download(Eigen::Index first, Eigen::Index count, Stream stream);
  /// What was downloaded, once the stream has been waited for. Throws by refuse_cost(), naming the
  /// first of `terms`, if a cost is NaN.
  void read(Eigen::Ref<Eigen::VectorXd> costs, const std::vector<ObjectiveTerm>& terms) const;

 private:
  Eigen::Index count_ = 0;
  DeviceBuffer<double> points_, costs_;
  PinnedBuffer<double> points_staging_, costs_staging_;
};

}  // namespace hypotrack::cuda
