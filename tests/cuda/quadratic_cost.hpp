#pragma once

#include <Eigen/Core>
#include <memory>

#include "hypotrack/plugin/optimizer.hpp"

namespace hypotrack::test {

/// sum of (d + 1) (x_d - target_d)^2, on the host and on the device, equal to the bit: one order of
/// operations, without contraction.
class QuadraticCost final : public CostFunction {
 public:
  /// Throws DeviceError where there is no GPU.
  explicit QuadraticCost(const Eigen::VectorXd& target);
  ~QuadraticCost() override;

  int dimension() const override;
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override;
  cuda::DeviceCost* device() override;

  /// Moves the target, as a new frame does: without another revision().
  void retarget(const Eigen::VectorXd& target);
  /// Makes revision() another one.
  void revise();
  /// How often DeviceCost::enqueue() was called.
  int enqueued() const;
  /// From now on the kernel fails.
  void break_down();

 private:
  struct Device;
  std::unique_ptr<Device> device_;
};

}  // namespace hypotrack::test
