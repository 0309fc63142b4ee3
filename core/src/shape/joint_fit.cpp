#include "shape/joint_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::internal {

JointProblem::~JointProblem() = default;

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A frame's part of the shape's normal equations, after elimination of its pose.
struct Reduced {
  MatrixXd hessian;        // PxP
  VectorXd gradient;       // P
  MatrixXd pose_by_shape;  // DxP: the step of the pose per step of the shape
  VectorXd pose_alone;     // D: the pose's own step
};

/// Adds a share of the diagonal and a little of its mean, which holds dimensions that no pixel
/// shows.
MatrixXd damped(MatrixXd hessian, double damping) {
  constexpr double kOfMean = 0.05;
  const double floor = kOfMean * hessian.diagonal().mean() + 1e-12;
  damp(hessian, damping, floor);
  return hessian;
}

Reduced reduce(const FrameSystem& system, Index shapes, double damping) {
  const Index d = system.gradient.size() - shapes;
  const MatrixXd pose = damped(system.hessian.topLeftCorner(d, d), damping);
  const MatrixXd mixed = system.hessian.topRightCorner(d, shapes);
  const Eigen::LDLT<MatrixXd> solver(pose);
  Reduced reduced;
  reduced.pose_by_shape = -solver.solve(mixed);
  reduced.pose_alone = -solver.solve(system.gradient.head(d));
  reduced.hessian =
      system.hessian.bottomRightCorner(shapes, shapes) + mixed.transpose() * reduced.pose_by_shape;
  reduced.gradient = system.gradient.tail(shapes) + mixed.transpose() * reduced.pose_alone;
  return reduced;
}

class Minimizer {
 public:
  Minimizer(JointProblem& problem, JointTrial start, const ShapePrior& prior)
      : problem_(problem), prior_(prior), trial_(std::move(start)) {
    trial_.shape = trial_.shape.cwiseMax(prior.lower).cwiseMin(prior.upper);
    costs_ = problem_.costs(trial_);
    keep_ = costs_.array().isFinite();
    if (!keep_.any()) throw DataError("shape: no frame can be scored at the poses to start from");
    cost_ = total(trial_, costs_);
  }

  double cost() const { return cost_; }
  const JointTrial& trial() const { return trial_; }

  /// Makes one accepted step. Returns its gain, 0 if no step was accepted.
  double step() {
    constexpr double kLongest = 8;
    systems_ = problem_.systems(trial_);
    const double before = cost_;
    const JointTrial from = trial_;
    for (; !damping_.exhausted(); damping_.reject()) {
      const Step step = solve();
      if (!accept(from, step, 1)) continue;
      double length = 2;
      while (length <= kLongest && accept(from, step, length)) length *= 2;
      damping_.accept();
      return before - cost_;
    }
    return 0;
  }

 private:
  MatrixXd prior_hessian() const { return 2 * prior_.weight * prior_.precision; }
  double total(const JointTrial& trial, const VectorXd& costs) const {
    const VectorXd off = trial.shape - prior_.mean;
    double sum = prior_.weight * off.dot(prior_.precision * off);
    for (Index k = 0; k < costs.size(); ++k)
      if (keep_[k]) sum += costs[k];
    return sum;
  }

  /// A step of the shape, and how each pose follows.
  struct Step {
    VectorXd shape;
    std::vector<Reduced> frames;
  };

  Step solve() const {
    const Index p = trial_.shape.size();
    MatrixXd hessian = prior_hessian();
    VectorXd gradient = hessian * (trial_.shape - prior_.mean);
    Step step;
    for (Index k = 0; k < keep_.size(); ++k) {
      step.frames.push_back(reduce(systems_[static_cast<std::size_t>(k)], p, damping_.value()));
      if (!keep_[k]) continue;
      hessian += step.frames.back().hessian;
      gradient += step.frames.back().gradient;
    }
    step.shape = -damped(hessian, damping_.value()).ldlt().solve(gradient);
    return step;
  }

  /// Returns the trial in which poses follow the shape and take `length` times their own step.
  JointTrial moved(const JointTrial& from, const Step& step, const VectorXd& shape,
                   double length) const {
    const VectorXd taken = shape - from.shape;
    JointTrial next{shape, from.poses};
    for (std::size_t k = 0; k < step.frames.size(); ++k) {
      const Reduced& frame = step.frames[k];
      next.poses[k] =
          problem_.moved(from.poses[k], frame.pose_by_shape * taken + length * frame.pose_alone);
    }
    return next;
  }

  /// Accepts `length` times the step if it lowers the total cost. Each frame takes the share of its
  /// pose's own step that is best for it, so one failing frame stops no other.
  bool accept(const JointTrial& from, const Step& step, double length) {
    const VectorXd shape =
        (from.shape + length * step.shape).cwiseMax(prior_.lower).cwiseMin(prior_.upper);
    JointTrial next = moved(from, step, shape, length);
    VectorXd costs = problem_.costs(next);
    for (const double share : {0.25, 0.0}) {
      const JointTrial other = moved(from, step, shape, share * length);
      const VectorXd others = problem_.costs(other);
      for (Index k = 0; k < costs.size(); ++k) {
        if (!(others[k] < costs[k])) continue;
        costs[k] = others[k];
        next.poses[static_cast<std::size_t>(k)] = other.poses[static_cast<std::size_t>(k)];
      }
    }
    const double cost = total(next, costs);
    if (!(cost < cost_)) return false;
    trial_ = std::move(next);
    cost_ = cost;
    return true;
  }

  JointProblem& problem_;
  const ShapePrior& prior_;
  JointTrial trial_;
  VectorXd costs_;
  Eigen::Array<bool, Eigen::Dynamic, 1> keep_;
  double cost_ = 0;
  Damping damping_{{.first = 0.1, .least = 1e-3, .most = 1e4, .accepted = 0.25, .rejected = 4}};
  std::vector<FrameSystem> systems_;
};

}  // namespace

JointFit fit_jointly(JointProblem& problem, JointTrial start, const ShapePrior& prior,
                     int iterations, const std::function<bool()>& stop) {
  constexpr double kEnough = 1e-4;
  Minimizer minimizer(problem, std::move(start), prior);
  JointFit fit;
  fit.first_cost = minimizer.cost();
  while (fit.iterations < iterations && !(stop && stop())) {
    ++fit.iterations;
    if (minimizer.step() < kEnough * std::abs(minimizer.cost())) break;
  }
  fit.best = minimizer.trial();
  fit.cost = minimizer.cost();
  return fit;
}

}  // namespace hypotrack::internal
