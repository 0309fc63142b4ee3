#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/exported.hpp"
#include "cost/cuda/frame_on_device.hpp"
#include "cost/cuda/host_batch.hpp"
#include "hypotrack/plugin/optimizer.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Memory of DeviceResiduals, kept from search to search.
struct ResidualMemory {
  DeviceBuffer<float> residuals;  ///< of the last batch, hypothesis by hypothesis
  DeviceBuffer<float> here;       ///< of the point of linearisation
  DeviceBuffer<float> parts;
  DeviceBuffer<double> sums;
  PinnedBuffer<double> sums_staging;
  PinnedBuffer<float> residuals_staging;
};

/// Residuals of states in GPU memory. It uploads states (DxN) and downloads costs, normal equations
/// or, if required, residuals. All arguments must outlive it; `cost` normalises states.
class DeviceResiduals final : public ResidualDifferences {
 public:
  DeviceResiduals(Cost& cost, FrameOnDevice& frame, HostBatch& batch, ResidualMemory& memory)
      : cost_(cost), frame_(frame), batch_(batch), memory_(memory) {}

  // ResidualDifferences; takes states instead of points.
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                Eigen::Ref<Eigen::VectorXd> costs) override;
  void move_to(Eigen::Index i) override;
  NormalEquations normal_equations(const Eigen::Ref<const Eigen::MatrixXd>& states,
                                   const Eigen::Ref<const Eigen::VectorXd>& scale,
                                   Eigen::Ref<Eigen::VectorXd> costs) override;

  /// Computes costs and residuals (M x N) of normalised states and downloads both. Splits batches
  /// that would take more than kMostBytes.
  void download(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::MatrixXf> residuals,
                Eigen::Ref<Eigen::VectorXd> costs);

 private:
  static constexpr Eigen::Index kMostBytes = Eigen::Index{1} << 26;

  void reserve(Eigen::Index states);
  /// Enqueues all work except the download of costs.
  void enqueue(const Eigen::MatrixXd& states);
  void finish(Eigen::Ref<Eigen::VectorXd> costs);

  Cost& cost_;
  FrameOnDevice& frame_;
  HostBatch& batch_;
  ResidualMemory& memory_;
};

/// Extracts the normal equations from the matrix of enqueue_gram(), for columns times `scale`.
NormalEquations unpack_gram(const double* sums, const Eigen::Ref<const Eigen::VectorXd>& scale);

}  // namespace internal
}  // namespace hypotrack::cuda
