#include "hypotrack/plugin/landmark_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack {
namespace {

constexpr double kMillimetres = 1e3;  // residuals are in millimetres
constexpr double kMillimetresPerRadian = 0.5;
constexpr DampingSchedule kDamping = {
    .first = 1e-3, .least = 1e-9, .most = 1e8, .accepted = 0.2, .rejected = 5};

std::vector<Eigen::Index> known_columns(const Model& model, const Eigen::Matrix3Xd& landmarks) {
  const auto expected = static_cast<Eigen::Index>(model.data().landmarks.size());
  if (landmarks.cols() != expected)
    throw DataError(
        fmt::format("{} landmarks were given to a model that has {}", landmarks.cols(), expected));
  std::vector<Eigen::Index> known;
  for (Eigen::Index i = 0; i < landmarks.cols(); ++i)
    if (landmarks.col(i).allFinite()) known.push_back(i);
  if (known.size() < 3)
    throw DataError(fmt::format("{} known landmarks do not say where a model is; give at least 3",
                                known.size()));
  return known;
}

/// The variables of the fit: a model's parameters and its scale.
struct Trial {
  Eigen::VectorXd parameters;
  double scale = 1;
};

class Problem {
 public:
  Problem(const Model& model, const Eigen::Matrix3Xd& landmarks,
          const LandmarkFitSettings& settings)
      : model_(model),
        known_(known_columns(model, landmarks)),
        targets_(landmarks(Eigen::all, known_)),
        angles_(model.dimension() - kPoseSize),
        unknowns_(6 + angles_ + (settings.scale ? 1 : 0)) {
    for (int i = 0; i < angles_; ++i) {
      const auto at = static_cast<std::size_t>(kPoseSize + i);
      prior_.push_back(settings.prior.empty() ? parameter(i).rest : settings.prior[at]);
    }
  }

  int unknowns() const { return unknowns_; }

  /// Applies a step: moves, rotates about the model's own axes, bends (within bounds) and scales.
  Trial moved(const Trial& from, const Eigen::VectorXd& step) const {
    Trial to = from;
    to.parameters.head<3>() += step.head<3>();
    const Eigen::Vector3d turn = step.segment<3>(3);
    const double angle = turn.norm();
    if (angle > 0) {
      const auto p = from.parameters.segment<4>(3);
      const Eigen::Quaterniond q = Eigen::Quaterniond(p[0], p[1], p[2], p[3]) *
                                   Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
      to.parameters.segment<4>(3) << q.w(), q.x(), q.y(), q.z();
      to.parameters.segment<4>(3).normalize();
    }
    for (int i = 0; i < angles_; ++i) {
      const Parameter& p = parameter(i);
      double& value = to.parameters[kPoseSize + i];
      value = std::clamp(value + step[6 + i], p.lower, p.upper);
    }
    if (unknowns_ > 6 + angles_) to.scale *= std::exp(step[6 + angles_]);
    return to;
  }

  Eigen::Matrix3Xd offsets(const Trial& trial) const {
    const Eigen::Vector3d position = trial.parameters.head<3>();
    const Eigen::Matrix3Xd all = posed_landmarks(
        model_, {trial.parameters.data(), static_cast<std::size_t>(trial.parameters.size())});
    const Eigen::Matrix3Xd posed = all(Eigen::all, known_);
    return ((trial.scale * (posed.colwise() - position)).colwise() + position) - targets_;
  }

  Eigen::VectorXd residuals(const Trial& trial) const {
    const Eigen::Matrix3Xd apart = offsets(trial);
    Eigen::VectorXd r(apart.size() + angles_);
    r.head(apart.size()) =
        kMillimetres / std::sqrt(static_cast<double>(known_.size())) * apart.reshaped();
    for (int i = 0; i < angles_; ++i)
      r[apart.size() + i] = kMillimetresPerRadian *
                            (trial.parameters[kPoseSize + i] - prior_[static_cast<std::size_t>(i)]);
    return r;
  }

  Eigen::MatrixXd jacobian(const Trial& trial, const Eigen::VectorXd& at) const {
    constexpr double kStep = 1e-6;
    Eigen::MatrixXd j(at.size(), unknowns_);
    for (int i = 0; i < unknowns_; ++i) {
      Eigen::VectorXd step = Eigen::VectorXd::Zero(unknowns_);
      const bool at_upper = i >= 6 && i < 6 + angles_ &&
                            trial.parameters[kPoseSize + i - 6] + kStep > parameter(i - 6).upper;
      step[i] = at_upper ? -kStep : kStep;
      j.col(i) = (residuals(moved(trial, step)) - at) / step[i];
    }
    return j;
  }

  /// Returns true if an angle is at a bound and descent would cross it.
  bool stuck(const Trial& trial, int unknown, double gradient) const {
    if (unknown < 6 || unknown >= 6 + angles_) return false;
    const Parameter& p = parameter(unknown - 6);
    const double value = trial.parameters[kPoseSize + unknown - 6];
    return blocked_by_bound(value, p.lower, p.upper, gradient);
  }

 private:
  const Parameter& parameter(int angle) const {
    return model_.data().parameters[static_cast<std::size_t>(kPoseSize + angle)];
  }

  const Model& model_;
  std::vector<Eigen::Index> known_;
  Eigen::Matrix3Xd targets_;
  int angles_;
  int unknowns_;
  std::vector<double> prior_;  // one per angle
};

/// Computes the damped Gauss-Newton step, 0 for angles that are stuck at a bound.
Eigen::VectorXd damped_step(const Problem& problem, const Trial& trial, const Eigen::MatrixXd& j,
                            const Eigen::VectorXd& r, double damping) {
  Eigen::VectorXd gradient = j.transpose() * r;
  Eigen::MatrixXd normal = j.transpose() * j;
  normal.diagonal() *= 1 + damping;
  for (int i = 0; i < problem.unknowns(); ++i) {
    if (!problem.stuck(trial, i, gradient[i])) continue;
    normal.row(i).setZero();
    normal.col(i).setZero();
    normal(i, i) = 1;
    gradient[i] = 0;
  }
  return -normal.ldlt().solve(gradient);
}

Trial minimize(const Problem& problem, Trial trial, int iterations) {
  constexpr double kEnough = 1e-8;
  Eigen::VectorXd r = problem.residuals(trial);
  Damping damping(kDamping);
  for (int i = 0; i < iterations && !damping.exhausted(); ++i) {
    const Eigen::MatrixXd j = problem.jacobian(trial, r);
    const double before = r.squaredNorm();
    while (!damping.exhausted()) {
      const Trial next = problem.moved(trial, damped_step(problem, trial, j, r, damping.value()));
      const Eigen::VectorXd r_next = problem.residuals(next);
      if (r_next.squaredNorm() < before) {
        trial = next;
        r = r_next;
        damping.accept();
        break;
      }
      damping.reject();
    }
    if (before - r.squaredNorm() < kEnough * before) break;
  }
  return trial;
}

}  // namespace

LandmarkFit fit_landmarks(const Model& model, const Eigen::Matrix3Xd& landmarks,
                          std::span<const double> start, const LandmarkFitSettings& settings) {
  const Problem problem(model, landmarks, settings);
  Trial first;
  first.parameters = Eigen::Map<const Eigen::VectorXd>(start.data(), model.dimension());
  first.parameters.segment<4>(3).normalize();
  const Trial best = minimize(problem, std::move(first), settings.iterations);
  const Eigen::VectorXd distances = problem.offsets(best).colwise().norm().transpose();
  return {best.parameters, best.scale, distances.mean(), distances.maxCoeff()};
}

Eigen::VectorXd align_to_landmarks(const Model& model, const Eigen::Matrix3Xd& landmarks,
                                   std::span<const double> start) {
  const std::vector<Eigen::Index> known = known_columns(model, landmarks);
  const Eigen::Matrix3Xd from = posed_landmarks(model, start)(Eigen::all, known);
  const Eigen::Matrix3Xd to = landmarks(Eigen::all, known);
  Eigen::Isometry3d to_from_from;
  to_from_from.matrix() = Eigen::umeyama(from, to, false);
  const Eigen::Isometry3d placed = to_from_from * world_from_model(start);
  Eigen::VectorXd out = Eigen::Map<const Eigen::VectorXd>(start.data(), model.dimension());
  const Eigen::Quaterniond q(placed.linear());
  out.head<7>() << placed.translation(), q.w(), q.x(), q.y(), q.z();
  return out;
}

}  // namespace hypotrack
