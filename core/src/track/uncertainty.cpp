#include "track/uncertainty.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "track/residual_information.hpp"
#include "track/tangent.hpp"

namespace hypotrack {
namespace {

// Steps of the differences: large enough to move edges by about a pixel.
constexpr double kPositionStep = 0.001;
constexpr double kRotationStep = 0.75 * kDegree;
constexpr double kAngleStep = 1.5 * kDegree;

/// For every number of the tangent space what a part's kind says.
Eigen::VectorXd per_kind(const Scene& scene, double position, double rotation, double angle) {
  const std::vector<TangentPart> parts = tangent_parts(scene);
  Eigen::VectorXd out(parts.back().first + parts.back().size);
  for (const TangentPart& part : parts) {
    const double value = part.kind == ParameterKind::position     ? position
                         : part.kind == ParameterKind::quaternion ? rotation
                                                                  : angle;
    out.segment(part.first, part.size).setConstant(value);
  }
  return out;
}

/// How far every number may be off that the images do not show. The limits of an angle leave no
/// more open than an even spread between them.
Eigen::VectorXd prior_width(const Scene& scene, const UncertaintySettings& settings) {
  Eigen::VectorXd width = per_kind(scene, settings.position, settings.rotation, settings.angle);
  auto parameter = scene.parameters().begin();
  const auto is_angle = [](const Parameter& p) { return p.kind == ParameterKind::angle; };
  for (const TangentPart& part : tangent_parts(scene)) {
    if (part.kind != ParameterKind::angle) continue;
    for (double& sigma : width.segment(part.first, part.size)) {
      parameter = std::find_if(parameter, scene.parameters().end(), is_angle);
      sigma = std::clamp((parameter->upper - parameter->lower) / std::sqrt(12.0), 1e-6, sigma);
      ++parameter;
    }
  }
  return width;
}

/// States on both sides of one, a pair of columns per number of the tangent space, and the widths
/// of these differences: less than two steps at a limit.
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

/// Landmarks (3L) over the tangent space.
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

}  // namespace

PoseUncertainty::PoseUncertainty(const Scene& scene, const UncertaintySettings& settings)
    : scene_(&scene),
      settings_(settings),
      steps_(per_kind(scene, kPositionStep, kRotationStep, kAngleStep)),
      precision_(prior_width(scene, settings).array().square().inverse()) {}

Eigen::VectorXd PoseUncertainty::of(Evaluator& evaluator, const Eigen::VectorXd& state) const {
  const Neighbours around(*scene_, state, steps_);
  Eigen::MatrixXd states(state.size(), evaluations());
  states << state, around.states;
  Eigen::MatrixXf residuals(evaluator.residual_count(), states.cols());
  Eigen::VectorXd costs(states.cols());
  evaluator.evaluate(states, residuals, costs);
  const auto landmarks = static_cast<Eigen::Index>(scene_->landmark_names().size());
  if (!costs.allFinite() || !residuals.allFinite())
    return Eigen::VectorXd::Constant(landmarks, std::numeric_limits<double>::infinity());

  for (const ResidualRows& rows : evaluator.pose_only_residuals())
    residuals.middleRows(rows.first, rows.count).setZero();
  const ResidualInformation info = residual_information(residuals, around.width);
  const double noise = settings_.noise * settings_.noise;
  Eigen::MatrixXd precision = info.a / noise;
  precision.diagonal() += precision_;
  const Eigen::LLT<Eigen::MatrixXd> llt(precision);
  // trace(L C L^T) is the squared norm of L times the inverse of the precision's root.
  const Eigen::MatrixXd root = llt.matrixL().solve(landmark_jacobian(*scene_, around).transpose());
  const Eigen::VectorXd step = llt.solve(-info.g / noise);
  const Eigen::Matrix3Xd way =
      scene_->landmarks(moved(*scene_, state, step)) - scene_->landmarks(state);
  Eigen::VectorXd sigma(landmarks);
  for (Eigen::Index i = 0; i < landmarks; ++i)
    sigma[i] = std::sqrt(root.middleCols<3>(3 * i).squaredNorm() + way.col(i).squaredNorm() +
                         settings_.floor * settings_.floor);
  return sigma;
}

}  // namespace hypotrack
