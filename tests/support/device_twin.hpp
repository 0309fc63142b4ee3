#pragma once

#include <functional>
#include <memory>

#include "hypotrack/cuda/device_cost.hpp"
#include "hypotrack/optimizer.hpp"

namespace hypotrack::test {

/// A cost function for optimizers that search on the GPU, of any other one: points are copied to
/// the host on their way along the stream, evaluated there, and their costs copied back.
class DeviceTwin final : public CostFunction {
 public:
  /// `host` outlives it and must not throw. Throws DeviceError where there is no GPU.
  explicit DeviceTwin(CostFunction& host);
  ~DeviceTwin() override;

  int dimension() const override;
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override;
  cuda::DeviceCost* device() override;

  /// Called by every DeviceCost::enqueue() first; may throw.
  void on_enqueue(std::function<void()> hook);
  /// Makes revision() another one, so that captured graphs are no longer valid.
  void revise();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack::test
