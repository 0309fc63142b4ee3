#include "least_squares_search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace hypotrack {

LeastSquaresSearch::LeastSquaresSearch(CostFunction& cost, ResidualCost& residuals,
                                       const SearchRegion& region, const Budget& budget,
                                       const LevenbergMarquardtParams& params)
    : cost_(cost),
      residual_cost_(residuals),
      region_(region),
      budget_(budget),
      params_(params),
      deadline_(budget.seconds),
      x_(region.start),
      analytic_(params.jacobian == Jacobian::analytic ||
                (params.jacobian == Jacobian::automatic && residuals.can_linearize())),
      differences_(analytic_ ? nullptr : residuals.differences()),
      damping_(
          {.first = params.damping, .least = 1e-7, .most = 1e7, .accepted = 1, .rejected = 1}) {}

bool LeastSquaresSearch::may_go_on() const { return remaining() > 0 && !deadline_.passed(); }

void LeastSquaresSearch::evaluate() {
  costs_.resize(points_.cols());
  if (analytic_) {
    cost_.evaluate(points_, costs_);
  } else {
    differences_->evaluate(points_, costs_);
  }
  best_.update(points_, costs_);
}

void LeastSquaresSearch::evaluate_start() {
  points_ = x_;
  evaluate();
  move_to(0);
}

void LeastSquaresSearch::move_to(Eigen::Index trial) {
  x_ = points_.col(trial);
  if (!analytic_) differences_->move_to(trial);
  cost_at_x_ = costs_[trial];
}

Eigen::VectorXd LeastSquaresSearch::differences(double share) const {
  Eigen::VectorXd steps = Eigen::VectorXd::Zero(x_.size());
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    const double wanted = share * region_.spread[i];
    const double up = std::min(region_.upper[i] - x_[i], wanted);
    const double down = std::min(x_[i] - region_.lower[i], wanted);
    const bool ahead = sign_ > 0 ? up >= std::min(down, wanted) : up > down;
    const double h = ahead ? up : -down;
    if (std::abs(h) > 1e-3 * wanted) steps[i] = h;
  }
  return steps;
}

bool LeastSquaresSearch::linearize() {
  const Eigen::Index d = x_.size();
  if (analytic_) return linearize_by_slopes();
  if (remaining() <= d) return false;  // nothing would be left for a step
  const Eigen::VectorXd steps = differences(params_.difference * fineness_);
  points_ = x_.replicate(1, d);
  points_.diagonal() += steps;
  const Eigen::VectorXd scale =
      (steps.array() == 0).select(0.0, region_.spread.array() / steps.array());
  costs_.resize(d);
  equations_ = differences_->normal_equations(points_, scale, costs_);
  best_.update(points_, costs_);
  sign_ = -sign_;
  return true;
}

bool LeastSquaresSearch::linearize_by_slopes() {
  if (remaining() <= 1) return false;
  constexpr double kShare = 0.01;  // surfaces move by a fraction of a pixel, far above rounding
  const Eigen::VectorXd steps = differences(kShare);
  points_ = x_.replicate(1, x_.size() + 1);
  points_.rightCols(x_.size()).diagonal() += steps;
  equations_ = residual_cost_.linearize(points_, steps, params_.blur * fineness_);
  best_.update(x_, Eigen::VectorXd::Constant(1, cost_at_x_));  // the linearisation counts as an
                                                               // evaluation
  const auto spread = region_.spread.asDiagonal();
  equations_.a = spread * equations_.a * spread;
  equations_.g = spread * equations_.g;
  return true;
}

Eigen::VectorXd LeastSquaresSearch::step(double damping) const {
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

bool LeastSquaresSearch::try_steps() {
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds && may_go_on(); ++round) {
    const auto trials = std::min<std::int64_t>(params_.trials, remaining());
    points_.resize(x_.size(), trials);
    const double lowest =
        damping_.value() * std::pow(params_.damping_factor, round == 0 ? -(trials / 2) : 0);
    for (Eigen::Index i = 0; i < trials; ++i) {
      points_.col(i) = within_bounds(
          x_ + step(lowest * std::pow(params_.damping_factor, i)).cwiseProduct(region_.spread),
          region_);
    }
    evaluate();
    Eigen::Index best = 0;
    if (costs_.minCoeff(&best) < cost_at_x_) {
      damping_.accept(lowest * std::pow(params_.damping_factor, best));
      moved_ = (points_.col(best) - x_).cwiseQuotient(region_.spread).cwiseAbs().maxCoeff();
      move_to(best);
      return true;
    }
    damping_.reject(lowest * std::pow(params_.damping_factor, trials));
  }
  return false;
}

void LeastSquaresSearch::leave_infeasible() {
  Eigen::Index best = 0;
  if (std::isfinite(costs_.minCoeff(&best))) move_to(best);
}

OptimizerResult LeastSquaresSearch::run() {
  evaluate_start();
  const int patience = analytic_ ? 1 : 2;  // numerical Jacobians have two signs
  int failed = 0;
  for (int i = 0; params_.iterations == 0 || i < params_.iterations; ++i) {
    if (!may_go_on() || !linearize()) break;
    if (!std::isfinite(cost_at_x_)) {
      leave_infeasible();
      if (!std::isfinite(cost_at_x_) && ++failed == 2) break;
      continue;
    }
    if (try_steps() && moved_ > params_.tolerance) {
      failed = 0;
    } else if (++failed == patience) {
      failed = 0;
      fineness_ *= 0.5;
      if (fineness_ < params_.finest) break;
      damping_.lower_to_first();
    }
  }
  return best_.result();
}

}  // namespace hypotrack
