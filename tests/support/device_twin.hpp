#pragma once

#include <functional>
#include <memory>

#include "hypotrack/gpu/device_cost.hpp"
#include "hypotrack/plugin/optimizer.hpp"

namespace hypotrack::test {

/// Adapts any cost function for optimizers that search on the GPU. Copies points to the host on
/// their way along the stream, evaluates them there, and copies their costs back.
class DeviceTwin final : public CostFunction {
 public:
  /// `host` must outlive the twin and not throw. Throws DeviceError without a GPU.
  explicit DeviceTwin(CostFunction& host);
  ~DeviceTwin() override;

  int dimension() const override;
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override;
  cuda::DeviceCost* device() override;

  /// Sets a function that every DeviceCost::enqueue() calls first; it may throw.
  void on_enqueue(std::function<void()> hook);
  /// Changes revision(), so that captured graphs become invalid.
  void revise();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack::test
