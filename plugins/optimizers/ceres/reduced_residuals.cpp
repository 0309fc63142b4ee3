#include "reduced_residuals.hpp"

#include <Eigen/Eigenvalues>

namespace hypotrack {

ReducedResiduals reduce(const NormalEquations& equations) {
  constexpr double kSingular = 1e-12;  // below it, eigenvalues are rounding
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(equations.a);
  const Eigen::VectorXd& values = eigen.eigenvalues();
  const Eigen::VectorXd roots =
      (values.array() > kSingular * values.cwiseAbs().maxCoeff()).select(values.array().sqrt(), 0);
  const Eigen::VectorXd inverse = (roots.array() > 0).select(roots.array().inverse(), 0);
  const Eigen::MatrixXd turned = eigen.eigenvectors().transpose();
  return {inverse.asDiagonal() * (turned * equations.g), roots.asDiagonal() * turned};
}

}  // namespace hypotrack
