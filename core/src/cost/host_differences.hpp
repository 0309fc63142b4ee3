#pragma once

#include <Eigen/Core>

#include "hypotrack/optimizer.hpp"

namespace hypotrack {

/// Keeps the residuals that a cost hands out. The cost must outlive it.
class HostDifferences final : public ResidualDifferences {
 public:
  explicit HostDifferences(ResidualCost& cost) : cost_(cost) {}

  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override;
  void move_to(Eigen::Index i) override { here_ = batch_.col(i); }
  NormalEquations normal_equations(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                   const Eigen::Ref<const Eigen::VectorXd>& scale,
                                   Eigen::Ref<Eigen::VectorXd> costs) override;

 private:
  ResidualCost& cost_;
  Eigen::MatrixXf batch_;  ///< residuals of the last one
  Eigen::VectorXf here_;
};

}  // namespace hypotrack
