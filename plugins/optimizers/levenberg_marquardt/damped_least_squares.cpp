#include "damped_least_squares.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack {

DampedSettings damped_settings(const LevenbergMarquardtParams& params,
                               DampedLeastSquares::Source source, std::int64_t evaluations,
                               Eigen::Index dimension) {
  using Source = DampedLeastSquares::Source;
  const bool analytic = source == Source::analytic, differences = source == Source::differences;
  return {.evaluations = evaluations,
          .price = (differences ? 0 : 1) + (analytic ? 0 : dimension),
          .iterations = params.iterations,
          .trials = params.trials,
          .patience = analytic ? 1 : 2,  // differences have two signs
          .leaves_infeasible = differences,
          .difference = analytic ? kAnalyticShare : params.difference,
          .blur = params.blur,
          .finest = params.finest,
          .damping = params.damping,
          .damping_factor = params.damping_factor,
          .mean_share = params.mean_share,
          .tolerance = params.tolerance};
}

DampedLeastSquares::DampedLeastSquares(const SearchRegion& region, std::int64_t evaluations,
                                       const LevenbergMarquardtParams& params, Source source)
    : region_(region),
      source_(source),
      steps_(damped_settings(params, source, evaluations, region.start.size())),
      x_(region.start),
      points_(region.start) {}

Eigen::Index DampedLeastSquares::take(const Eigen::VectorXd& costs) {
  best_.update(points_, costs);
  count(costs.size());
  if (steps_.round < 0) {  // the start
    move_to(0);
    steps_.begin(costs[0]);
    return 0;
  }
  Eigen::Index best = 0;
  if (costs.minCoeff(&best) < steps_.cost) {
    const double moved =
        (points_.col(best) - x_).cwiseQuotient(region_.spread).cwiseAbs().maxCoeff();
    move_to(best);
    steps_.accept(static_cast<std::int32_t>(best), costs[best], moved);
    return best;
  }
  steps_.reject();
  place_trials();
  return -1;
}

Neighbourhood DampedLeastSquares::neighbourhood() const {
  const double share =
      steps_.settings.difference * (source_ == Source::analytic ? 1 : steps_.fineness);
  return hypotrack::neighbourhood(x_, difference_steps(region_, x_, share, sign_),
                                  steps_.settings.blur * steps_.fineness);
}

void DampedLeastSquares::take(const NormalEquations& equations) {
  best_.count(steps_.settings.price);
  count(steps_.settings.price);
  equations_ = per_spread(equations, region_);
  if (source_ == Source::mixed) sign_ = -sign_;
  steps_.solve();
  place_trials();
}

Eigen::Index DampedLeastSquares::take(const NormalEquations& equations, const Neighbourhood& at,
                                      const Eigen::VectorXd& costs) {
  points_ = at.points.rightCols(x_.size());
  best_.update(points_, costs);
  count(costs.size());
  equations_ = equations;
  sign_ = -sign_;
  if (steps_.is_feasible()) {
    steps_.solve();
    place_trials();
    return -1;
  }
  // Nothing is known about an infeasible point: leave it.
  Eigen::Index best = 0;
  const bool leaves = std::isfinite(costs.minCoeff(&best));
  if (leaves) move_to(best);
  steps_.leave(leaves, costs[best]);
  return leaves ? best : -1;
}

Eigen::VectorXd DampedLeastSquares::step(double damping) const {
  const Eigen::Index d = x_.size();
  const Eigen::VectorXd diagonal = equations_.a.diagonal();
  const double firm = steps_.settings.mean_share * diagonal.mean();
  // Dimensions stay if they are at a bound and want to leave, or if nothing depends on them.
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < d; ++i) {
    const bool held = blocked_by_bound(x_[i], region_.lower[i], region_.upper[i], equations_.g[i]);
    if (!held && diagonal[i] > 0) free.push_back(i);
  }
  Eigen::VectorXd dx = Eigen::VectorXd::Zero(d);
  if (free.empty()) return dx;
  Eigen::MatrixXd a = equations_.a(free, free);
  damp(a, damping, firm);
  const Eigen::VectorXd solved = a.ldlt().solve(-equations_.g(free));
  if (!solved.allFinite()) return dx;
  dx(free) = solved.cwiseMax(-1.0).cwiseMin(1.0);
  return dx;
}

void DampedLeastSquares::place_trials() {
  if (steps_.wants != Wants::costs) return;
  points_.resize(x_.size(), steps_.points);
  for (std::int32_t i = 0; i < steps_.points; ++i) {
    const Eigen::VectorXd dx = step(steps_.damping_of(i));
    points_.col(i) = within_bounds(x_ + dx.cwiseProduct(region_.spread), region_);
  }
}

}  // namespace hypotrack
