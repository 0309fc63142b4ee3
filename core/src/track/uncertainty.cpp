#include "track/uncertainty.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "track/tangent.hpp"

namespace hypotrack::internal {
namespace {

// Steps of the finite differences: large enough to move edges by about a pixel.
constexpr double kPositionStep = 0.001;
constexpr double kRotationStep = 0.75 * kDegree;
constexpr double kAngleStep = 1.5 * kDegree;

/// Returns a vector over the tangent space with one value per kind of dimension.
Eigen::VectorXd per_kind(const Scene& scene, double position, double rotation, double angle) {
  const std::vector<TangentPart> parts = tangent_parts(scene);
  Eigen::VectorXd out(parts.back().first + parts.back().size);
  for (const TangentPart& part : parts) {
    const double value = is_in_metres(part.kind)                  ? position
                         : part.kind == ParameterKind::quaternion ? rotation
                                                                  : angle;
    out.segment(part.first, part.size).setConstant(value);
  }
  return out;
}

/// Returns the prior standard deviation of every dimension. A joint's is at most that of a uniform
/// distribution between its limits.
Eigen::VectorXd prior_width(const Scene& scene, const UncertaintySettings& settings) {
  Eigen::VectorXd width = per_kind(scene, settings.position, settings.rotation, settings.angle);
  auto parameter = scene.parameters().begin();
  const auto moves_joints = [](const Parameter& p) { return is_joint(p.kind); };
  for (const TangentPart& part : tangent_parts(scene)) {
    if (!is_joint(part.kind)) continue;
    for (double& sigma : width.segment(part.first, part.size)) {
      parameter = std::find_if(parameter, scene.parameters().end(), moves_joints);
      sigma = std::clamp((parameter->upper - parameter->lower) / std::sqrt(12.0), 1e-6, sigma);
      ++parameter;
    }
  }
  return width;
}

/// States on both sides of one, a pair of columns per dimension of the tangent space. `width` has
/// the widths of these differences, which are less than two steps at a limit.
struct Neighbours {
  Neighbours(const Scene& scene, const Eigen::VectorXd& state, const Eigen::VectorXd& steps)
      : states(state.size(), 2 * steps.size()), width(steps.size()) {
    for (Eigen::Index d = 0; d < steps.size(); ++d) {
      const Eigen::VectorXd step = steps[d] * Eigen::VectorXd::Unit(steps.size(), d);
      states.col(2 * d) = moved(scene, state, -step);
      states.col(2 * d + 1) = moved(scene, state, step);
      width[d] = difference(scene, states.col(2 * d), states.col(2 * d + 1))[d];
    }
  }

  Eigen::MatrixXd states;
  Eigen::VectorXd width;
};

/// Computes the Jacobian of the landmarks (3L) over the tangent space.
Eigen::MatrixXd landmark_jacobian(const Scene& scene, const Neighbours& around) {
  const auto rows = static_cast<Eigen::Index>(3 * scene.landmark_names().size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, around.width.size());
  for (Eigen::Index d = 0; d < around.width.size(); ++d) {
    if (!(around.width[d] > 0)) continue;
    const Eigen::Matrix3Xd low = scene.landmarks(around.states.col(2 * d));
    const Eigen::Matrix3Xd high = scene.landmarks(around.states.col(2 * d + 1));
    out.col(d) = (high - low).reshaped() / around.width[d];
  }
  return out;
}

/// Posterior of the residuals' information and a prior of given widths. Works in units of the
/// prior's widths, where the prior's information is the identity, and in the eigenvectors of the
/// residuals' information. So directions about which the residuals say nothing keep the prior's
/// variance exactly.
class Posterior {
 public:
  Posterior(const ResidualInformation& info, const Eigen::VectorXd& width, double noise)
      : width_(width) {
    const double factor = 1 / (noise * noise);
    const Eigen::MatrixXd a = factor * (width.asDiagonal() * info.a * width.asDiagonal());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
    const Eigen::VectorXd& known = solver.eigenvalues();
    directions_ = solver.eigenvectors();
    gradient_ = factor * (directions_.transpose() * (width.asDiagonal() * info.g));
    // Rounding error of an eigenvalue 0.
    const double rounding = static_cast<double>(known.size()) *
                            std::numeric_limits<double>::epsilon() * known.cwiseAbs().maxCoeff();
    open_ = Eigen::VectorXd::Ones(known.size());
    for (Eigen::Index i = 0; i < known.size(); ++i) {
      if (known[i] > rounding)
        open_[i] = 1 / (1 + known[i]);
      else
        gradient_[i] = 0;
    }
  }

  /// Returns a matrix whose squared norm is trace(L C L^T), for a Jacobian L and the covariance C.
  Eigen::MatrixXd root(const Eigen::MatrixXd& jacobian) const {
    return open_.cwiseSqrt().asDiagonal() *
           (directions_.transpose() * (width_.asDiagonal() * jacobian.transpose()));
  }
  Eigen::VectorXd way_to_minimum() const {
    return -(width_.asDiagonal() * (directions_ * open_.cwiseProduct(gradient_)));
  }

 private:
  const Eigen::VectorXd& width_;
  Eigen::MatrixXd directions_;
  Eigen::VectorXd open_;      // variance along each, relative to the prior's
  Eigen::VectorXd gradient_;  // J^T r along each
};

}  // namespace

PoseUncertainty::PoseUncertainty(const Scene& scene, const UncertaintySettings& settings)
    : scene_(&scene),
      settings_(settings),
      steps_(per_kind(scene, kPositionStep, kRotationStep, kAngleStep)),
      width_(prior_width(scene, settings)) {}

Eigen::VectorXd PoseUncertainty::of(Cost& cost, const Eigen::VectorXd& state) const {
  StateResiduals& of_states = *cost.least_squares();
  const Neighbours around(*scene_, state, steps_);
  Eigen::MatrixXd states(state.size(), evaluations());
  states << state, around.states;
  Eigen::MatrixXf residuals(of_states.count(), states.cols());
  Eigen::VectorXd costs(states.cols());
  of_states.evaluate(states, residuals, costs);
  const auto landmarks = static_cast<Eigen::Index>(scene_->landmark_names().size());
  if (!costs.allFinite() || !residuals.allFinite())
    return Eigen::VectorXd::Constant(landmarks, std::numeric_limits<double>::infinity());

  for (const ResidualRows& rows : of_states.pose_only())
    residuals.middleRows(rows.first, rows.count).setZero();
  const ResidualInformation info = residual_information(residuals, around.width);
  const Posterior posterior(info, width_, settings_.noise);
  const Eigen::MatrixXd root = posterior.root(landmark_jacobian(*scene_, around));
  const Eigen::VectorXd step = posterior.way_to_minimum();
  const Eigen::Matrix3Xd way =
      scene_->landmarks(moved(*scene_, state, step)) - scene_->landmarks(state);
  Eigen::VectorXd sigma(landmarks);
  for (Eigen::Index i = 0; i < landmarks; ++i)
    sigma[i] = std::sqrt(root.middleCols<3>(3 * i).squaredNorm() + way.col(i).squaredNorm() +
                         settings_.floor * settings_.floor);
  return sigma;
}

}  // namespace hypotrack::internal
