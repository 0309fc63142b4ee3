#pragma once

#include <Eigen/Core>
#include <vector>

#include "cost/cuda/frame_on_device.hpp"
#include "cost/cuda/host_batch.hpp"
#include "hypotrack/optimizer.hpp"

namespace hypotrack::cuda {

/// Residuals of hypotheses in GPU memory: states (normalised, DxN) go up, and costs, normal
/// equations or, if need be, the residuals themselves come down. Frame and batch outlive it.
class DeviceResiduals final : public ResidualDifferences {
 public:
  DeviceResiduals(FrameOnDevice& frame, HostBatch& batch) : frame_(frame), batch_(batch) {}

  // ResidualDifferences, with states in place of points
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                Eigen::Ref<Eigen::VectorXd> costs) override;
  void move_to(Eigen::Index i) override;
  NormalEquations normal_equations(const Eigen::Ref<const Eigen::MatrixXd>& states,
                                   const Eigen::Ref<const Eigen::VectorXd>& scale,
                                   Eigen::Ref<Eigen::VectorXd> costs) override;

  /// The residuals too (residual_count() x N). Computed in several goes where they take more than
  /// kMostBytes.
  void download(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::MatrixXf> residuals,
                Eigen::Ref<Eigen::VectorXd> costs);

 private:
  static constexpr Eigen::Index kMostBytes = Eigen::Index{1} << 26;

  void reserve(Eigen::Index states);
  /// Enqueues everything up to the download of costs.
  void enqueue(const Eigen::MatrixXd& states);
  void finish(Eigen::Ref<Eigen::VectorXd> costs);

  FrameOnDevice& frame_;
  HostBatch& batch_;
  DeviceBuffer<float> residuals_;  // of the last batch, hypothesis by hypothesis
  DeviceBuffer<float> here_;
  DeviceBuffer<float> parts_;
  DeviceBuffer<double> sums_;
  PinnedBuffer<double> sums_staging_;
  PinnedBuffer<float> residuals_staging_;
};

/// Takes the matrix of inner products apart that enqueue_gram() leaves, for columns times `scale`.
HYPOTRACK_API NormalEquations unpack_gram(const double* sums,
                                          const Eigen::Ref<const Eigen::VectorXd>& scale);

}  // namespace hypotrack::cuda
