#include "cost/linearize/term_equations.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace hypotrack::internal {
namespace {

/// Adds the products of a Jacobian by search dimensions.
void add(double weight, const Eigen::MatrixXd& j, const Eigen::VectorXd& r, NormalEquations& sums) {
  sums.a += weight * j.transpose() * j;
  sums.g += weight * j.transpose() * r;
}

}  // namespace

Eigen::MatrixXd state_derivatives(const Scene& scene, const Eigen::MatrixXd& states,
                                  const Eigen::VectorXd& steps) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(states.rows(), steps.size());
  for (Eigen::Index i = 0; i < steps.size(); ++i) {
    if (steps[i] != 0) out.col(i) = (states.col(i + 1) - states.col(0)) / steps[i];
  }
  for (const Scene::Item& item : scene.items()) {
    const Eigen::Vector4d quaternion = states.col(0).segment<4>(item.offset + 3);
    auto rows = out.middleRows<4>(item.offset + 3);
    rows -= (quaternion * (quaternion.transpose() * rows)).eval();  // chords leave the sphere
  }
  return out;
}

void add_by_jacobian(const ObjectiveTerm& term, const RenderedHypothesis& hypothesis,
                     const Eigen::MatrixXd& derivatives, NormalEquations& sums) {
  const ResidualTerm& residuals = *term.objective->residual_term();
  const auto count = static_cast<Eigen::Index>(residuals.residual_count());
  if (count == 0) return;
  std::vector<float> r(static_cast<std::size_t>(count));
  Jacobian jacobian = Jacobian::Zero(count, derivatives.rows());
  residuals.write_jacobian(hypothesis, r, jacobian);
  add(term.weight, jacobian.cast<double>() * derivatives,
      Eigen::Map<const Eigen::VectorXf>(r.data(), count).cast<double>(), sums);
}

void add_by_differences(const ObjectiveTerm& term, const Eigen::MatrixXd& states,
                        const Eigen::VectorXd& steps, NormalEquations& sums) {
  const ResidualTerm& residuals = *term.objective->residual_term();
  const auto count = static_cast<Eigen::Index>(residuals.residual_count());
  if (count == 0) return;
  const auto rows = static_cast<std::size_t>(count);
  Eigen::MatrixXf r(count, states.cols());
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    if (i > 0 && steps[i - 1] == 0) continue;
    residuals.write_residuals({{states.col(i).data(), static_cast<std::size_t>(states.rows())}, {}},
                              {r.col(i).data(), rows});
  }
  const Eigen::VectorXd at = r.col(0).cast<double>();
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(count, steps.size());
  for (Eigen::Index i = 0; i < steps.size(); ++i) {
    if (steps[i] != 0) j.col(i) = (r.col(i + 1).cast<double>() - at) / steps[i];
  }
  add(term.weight, j, at, sums);
}

}  // namespace hypotrack::internal
