#include "cost/linearize/term_equations.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace hypotrack::internal {
namespace {

/// Adds the products of a Jacobian by search dimensions, from dimension `first` on.
void add(double weight, const Eigen::MatrixXd& j, const Eigen::VectorXd& r, NormalEquations& sums,
         Eigen::Index first = 0) {
  sums.a.block(first, first, j.cols(), j.cols()) += weight * j.transpose() * j;
  sums.g.segment(first, j.cols()) += weight * j.transpose() * r;
}

/// Columns of a matrix that follow each other.
struct Columns {
  Eigen::Index first = 0, count = 0;
  bool operator==(const Columns&) const = default;
};

/// Returns the columns of the first to the last model that a row depends on.
Columns columns_of(const Scene& scene, const Jacobian& jacobian, Eigen::Index row) {
  Columns out;
  for (const Scene::Item& item : scene.items()) {
    const Eigen::Index size = item.model->dimension();
    if ((jacobian.row(row).segment(item.offset, size).array() == 0).all()) continue;
    if (out.count == 0) out.first = item.offset;
    out.count = item.offset + size - out.first;
  }
  return out;
}

/// Returns the columns from the first to the last that is not 0.
Columns used_columns(const Eigen::MatrixXd& matrix) {
  Columns out;
  for (Eigen::Index i = 0; i < matrix.cols(); ++i) {
    if ((matrix.col(i).array() == 0).all()) continue;
    if (out.count == 0) out.first = i;
    out.count = i + 1 - out.first;
  }
  return out;
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

void add_by_jacobian(const Scene& scene, const ObjectiveTerm& term,
                     const RenderedHypothesis& hypothesis, const Eigen::MatrixXd& derivatives,
                     NormalEquations& sums) {
  const ResidualTerm& residuals = *term.objective->residual_term();
  const auto count = static_cast<Eigen::Index>(residuals.residual_count());
  if (count == 0) return;
  std::vector<float> r(static_cast<std::size_t>(count));
  Jacobian jacobian = Jacobian::Zero(count, derivatives.rows());
  residuals.write_jacobian(hypothesis, r, jacobian);
  const auto residual = Eigen::Map<const Eigen::VectorXf>(r.data(), count).cast<double>();
  if (scene.items().size() == 1)
    return add(term.weight, jacobian.cast<double>() * derivatives, residual, sums);
  for (Eigen::Index first = 0, end = 0; first < count; first = end) {
    const Columns state = columns_of(scene, jacobian, first);
    for (end = first + 1; end < count && columns_of(scene, jacobian, end) == state;) ++end;
    if (state.count == 0) continue;
    const Eigen::MatrixXd of_models = derivatives.middleRows(state.first, state.count);
    const Columns search = used_columns(of_models);
    const Eigen::MatrixXd j =
        jacobian.block(first, state.first, end - first, state.count).cast<double>() *
        of_models.middleCols(search.first, search.count);
    add(term.weight, j, residual.segment(first, end - first), sums, search.first);
  }
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
