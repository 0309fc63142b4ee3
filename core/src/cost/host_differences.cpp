#include "cost/host_differences.hpp"

#include "cost/normal_equations.hpp"

namespace hypotrack {

void HostDifferences::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                               Eigen::Ref<Eigen::VectorXd> costs) {
  batch_.resize(cost_.count(), points.cols());
  cost_.evaluate(points, batch_, costs);
}

NormalEquations HostDifferences::normal_equations(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                                  const Eigen::Ref<const Eigen::VectorXd>& scale,
                                                  Eigen::Ref<Eigen::VectorXd> costs) {
  evaluate(points, costs);
  return hypotrack::normal_equations(here_, batch_, scale_of_finite(scale, costs));
}

}  // namespace hypotrack
