#include <Eigen/Core>
#include <memory>

#include "cost/linearize/difference_blocks.hpp"
#include "hypotrack/plugin/optimizer.hpp"

namespace hypotrack {
namespace {

/// Numerical normal equations from the residuals that a cost returns. The cost must outlive it.
class HostDifferences final : public ResidualDifferences {
 public:
  explicit HostDifferences(ResidualCost& cost) : cost_(cost) {}

  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override {
    batch_.resize(cost_.count(), points.cols());
    cost_.evaluate(points, batch_, costs);
  }
  void move_to(Eigen::Index i) override { here_ = batch_.col(i); }
  NormalEquations normal_equations(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                   const Eigen::Ref<const Eigen::VectorXd>& scale,
                                   Eigen::Ref<Eigen::VectorXd> costs) override {
    evaluate(points, costs);
    return hypotrack::normal_equations(here_, batch_, scale_of_finite(scale, costs));
  }

 private:
  ResidualCost& cost_;
  Eigen::MatrixXf batch_;  // residuals of the last batch
  Eigen::VectorXf here_;
};

}  // namespace

std::unique_ptr<ResidualDifferences> ResidualCost::differences() {
  return std::make_unique<HostDifferences>(*this);
}

}  // namespace hypotrack
