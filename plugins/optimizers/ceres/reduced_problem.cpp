#include "reduced_problem.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <span>

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

ReducedProblem::ReducedProblem(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                               const LinearizationParams& params)
    : limit_(budget.evaluations),
      deadline_(budget.seconds),
      space_(region),
      start_(region.start),
      linearizer_(cost, region, params, best_) {}

void ReducedProblem::evaluate_start() { last_cost_ = linearizer_.evaluate(start_); }

bool ReducedProblem::affords(std::int64_t evaluations) {
  if (remaining() < evaluations || deadline_.passed()) finished_ = true;
  return !finished_;
}

bool ReducedProblem::try_evaluate(const double* offsets, double* residuals, double* jacobian) {
  const int n = space_.dimension();
  const Eigen::VectorXd point = space_.point({offsets, static_cast<std::size_t>(n)});
  if (!point.allFinite()) return false;
  if (linearizer_.point() != point) {
    if (!affords(1)) return false;
    last_cost_ = linearizer_.evaluate(point);
  }
  if (!std::isfinite(last_cost_)) return false;
  Eigen::Map<Eigen::VectorXd> out(residuals, n + 1);
  out.setZero();
  if (jacobian) {
    if (!affords(linearizer_.price())) return false;
    const NormalEquations all = linearizer_.equations();
    const ReducedResiduals reduced = reduce({space_.free_block(all.a), space_.free_part(all.g)});
    out.head(n) = reduced.residuals;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor> slopes(jacobian, n + 1, n);
    slopes.topRows(n) = reduced.jacobian;
    slopes.row(n).setZero();
    if (!shift_) shift_ = std::abs(last_cost_) + 2 * reduced.residuals.squaredNorm();
  }
  out[n] = std::sqrt(std::max(
      last_cost_ + shift_.value_or(std::abs(last_cost_)) - out.head(n).squaredNorm(), 0.0));
  return true;
}

bool ReducedProblem::evaluate(const double* offsets, double* residuals, double* jacobian) {
  last_offsets_ = Eigen::Map<const Eigen::VectorXd>(offsets, space_.dimension());
  try {
    if (!error_ && !finished_ && try_evaluate(offsets, residuals, jacobian)) return true;
  } catch (...) {  // must not pass through a library that knows no exceptions
    error_ = std::current_exception();
  }
  if (!jacobian) return false;
  std::fill_n(residuals, residual_count(), 0.0);
  std::fill_n(jacobian, residual_count() * space_.dimension(), 0.0);
  return true;
}

void ReducedProblem::rethrow() const {
  if (error_) std::rethrow_exception(error_);
}

}  // namespace hypotrack
