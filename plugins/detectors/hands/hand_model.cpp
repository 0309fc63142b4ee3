#include "hand_model.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "hypotrack/kinematics.hpp"

namespace hypotrack {
namespace {

constexpr std::size_t kWrist = 0, kIndexKnuckle = 5, kMiddleTip = 12, kLittleKnuckle = 17;

/// Returns the model's landmarks at rest, with every angle moved by a share of the way to its upper
/// bound.
Eigen::Matrix3Xd bent(const Model& model, double share) {
  std::vector<double> parameters;
  for (const Parameter& p : model.data().parameters) {
    const bool bends = p.kind == ParameterKind::angle && std::isfinite(p.upper);
    parameters.push_back(bends ? p.rest + share * (p.upper - p.rest) : p.rest);
  }
  return posed_landmarks(model, parameters);
}

}  // namespace

HandPoints3D HandModel::in_detector_order(const Eigen::Matrix3Xd& of_model) const {
  HandPoints3D out = HandPoints3D::Constant(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (landmarks[i] >= 0) out.col(static_cast<Eigen::Index>(i)) = of_model.col(landmarks[i]);
  }
  return out;
}

Eigen::Matrix3Xd HandModel::in_model_order(const HandPoints3D& detected, Eigen::Index count) const {
  Eigen::Matrix3Xd out =
      Eigen::Matrix3Xd::Constant(3, count, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    if (landmarks[i] >= 0) out.col(landmarks[i]) = detected.col(static_cast<Eigen::Index>(i));
  return out;
}

std::optional<HandModel> hand_model(const Model& model) {
  constexpr std::ptrdiff_t kLeast = 11;
  constexpr double kGrip = 0.3, kLeastBend = 1e-3;
  HandModel out;
  const auto& names = model.data().landmarks;
  for (std::size_t i = 0; i < kHandPointNames.size(); ++i) {
    const auto found = std::ranges::find_if(
        names, [&](const Landmark& l) { return l.name == kHandPointNames[i]; });
    out.landmarks[i] = found == names.end() ? -1 : found - names.begin();
  }
  for (const std::size_t i : {kWrist, kIndexKnuckle, kMiddleTip, kLittleKnuckle}) {
    if (out.landmarks[i] < 0) return std::nullopt;
  }
  if (std::ranges::count_if(out.landmarks, [](Eigen::Index i) { return i >= 0; }) < kLeast) {
    return std::nullopt;
  }
  // Fingers bend to the palm's side, which tells a right hand from a left one.
  const HandPoints3D rest = out.in_detector_order(bent(model, 0));
  const HandPoints3D grip = out.in_detector_order(bent(model, kGrip));
  const Eigen::Vector3d wrist = rest.col(kWrist);
  const Eigen::Vector3d across =
      (rest.col(kIndexKnuckle) - wrist).cross(rest.col(kLittleKnuckle) - wrist);
  const double side = across.dot(grip.col(kMiddleTip) - rest.col(kMiddleTip));
  const double length = (rest.col(kMiddleTip) - wrist).norm();
  if (!(std::abs(side) > kLeastBend * across.norm() * length)) return std::nullopt;
  out.right = side > 0;
  return out;
}

}  // namespace hypotrack
