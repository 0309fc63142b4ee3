#include "damped_least_squares.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace hypotrack {

DampedLeastSquares::DampedLeastSquares(const SearchRegion& region, std::int64_t evaluations,
                                       const LevenbergMarquardtParams& params, Source source)
    : region_(region),
      evaluations_(evaluations),
      params_(params),
      source_(source),
      x_(region.start),
      damping_({.first = params.damping, .least = 1e-7, .most = 1e7, .accepted = 1, .rejected = 1}),
      points_(region.start) {}

void DampedLeastSquares::move_to(Eigen::Index point, const Eigen::VectorXd& costs) {
  x_ = points_.col(point);
  cost_at_x_ = costs[point];
}

Eigen::Index DampedLeastSquares::take(const Eigen::VectorXd& costs) {
  best_.update(points_, costs);
  if (round_ < 0) {  // the start
    move_to(0, costs);
    want_equations();
    return 0;
  }
  Eigen::Index best = 0;
  if (costs.minCoeff(&best) < cost_at_x_) {
    damping_.accept(lowest_ * std::pow(params_.damping_factor, best));
    const double moved =
        (points_.col(best) - x_).cwiseQuotient(region_.spread).cwiseAbs().maxCoeff();
    move_to(best, costs);
    end_of_steps(moved > params_.tolerance);
    return best;
  }
  constexpr int kRounds = 2;
  damping_.reject(lowest_ * std::pow(params_.damping_factor, static_cast<double>(points_.cols())));
  if (round_ + 1 < kRounds && remaining() > 0) {
    want_trials(round_ + 1);
  } else {
    end_of_steps(false);
  }
  return -1;
}

std::int64_t DampedLeastSquares::price() const {
  const Eigen::Index here = source_ == Source::differences ? 0 : 1;
  return here + (source_ == Source::analytic ? 0 : x_.size());
}

void DampedLeastSquares::want_equations() {
  const bool allowed = params_.iterations == 0 || jacobians_ < params_.iterations;
  const bool enough = remaining() > price();  // otherwise nothing would be left for a step
  const bool possible = std::isfinite(cost_at_x_) || source_ == Source::differences;
  wants_ = allowed && enough && possible ? Wants::equations : Wants::nothing;
}

Neighbourhood DampedLeastSquares::neighbourhood() const {
  const double share =
      source_ == Source::analytic ? kAnalyticShare : params_.difference * fineness_;
  return hypotrack::neighbourhood(x_, difference_steps(region_, x_, share, sign_),
                                  params_.blur * fineness_);
}

void DampedLeastSquares::take(const NormalEquations& equations) {
  ++jacobians_;
  best_.count(price());
  equations_ = per_spread(equations, region_);
  if (source_ == Source::mixed) sign_ = -sign_;
  want_trials(0);
}

Eigen::Index DampedLeastSquares::take(const NormalEquations& equations, const Neighbourhood& at,
                                      const Eigen::VectorXd& costs) {
  ++jacobians_;
  points_ = at.points.rightCols(x_.size());
  best_.update(points_, costs);
  equations_ = equations;
  sign_ = -sign_;
  if (std::isfinite(cost_at_x_)) {
    want_trials(0);
    return -1;
  }
  // Nothing is known about an infeasible point: leave it.
  Eigen::Index best = 0;
  const bool leaves = std::isfinite(costs.minCoeff(&best));
  if (leaves) move_to(best, costs);
  if (!leaves && ++failed_ == 2) {
    wants_ = Wants::nothing;
  } else {
    want_equations();
  }
  return leaves ? best : -1;
}

Eigen::VectorXd DampedLeastSquares::step(double damping) const {
  const Eigen::Index d = x_.size();
  const Eigen::VectorXd diagonal = equations_.a.diagonal();
  const double firm = params_.mean_share * diagonal.mean();
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

void DampedLeastSquares::want_trials(int round) {
  const auto trials = std::min<std::int64_t>(params_.trials, remaining());
  wants_ = Wants::costs;
  round_ = round;
  lowest_ = damping_.value() * std::pow(params_.damping_factor, round == 0 ? -(trials / 2) : 0);
  points_.resize(x_.size(), trials);
  for (Eigen::Index i = 0; i < trials; ++i) {
    const Eigen::VectorXd dx =
        step(lowest_ * std::pow(params_.damping_factor, static_cast<double>(i)));
    points_.col(i) = within_bounds(x_ + dx.cwiseProduct(region_.spread), region_);
  }
}

void DampedLeastSquares::end_of_steps(bool gained) {
  const int patience = source_ == Source::analytic ? 1 : 2;  // differences have two signs
  if (gained) {
    failed_ = 0;
  } else if (++failed_ == patience) {
    failed_ = 0;
    fineness_ *= 0.5;
    if (fineness_ < params_.finest) {
      wants_ = Wants::nothing;
      return;
    }
    damping_.lower_to_first();
  }
  want_equations();
}

}  // namespace hypotrack
