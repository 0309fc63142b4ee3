#include "cost/normal_equations.hpp"

#include "cost/difference_blocks.hpp"

namespace hypotrack::internal {

NormalEquations normal_equations(const Eigen::Ref<const Eigen::VectorXf>& r,
                                 const Eigen::Ref<const Eigen::MatrixXf>& beside,
                                 const Eigen::VectorXd& scale) {
  const auto rows = static_cast<std::size_t>(r.size());
  DifferenceBlocks differences;
  differences.begin({r.data(), rows}, beside.cols());
  for (Eigen::Index i = 0; i < beside.cols(); ++i) {
    differences.set(i, {beside.col(i).data(), rows});
  }
  return differences.normal_equations(scale);
}

Eigen::VectorXd scale_of_finite(const Eigen::Ref<const Eigen::VectorXd>& scale,
                                const Eigen::Ref<const Eigen::VectorXd>& costs) {
  return costs.array().isFinite().select(scale.array(), 0.0);
}

}  // namespace hypotrack::internal
