#include "hand_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "hypotrack/kinematics.hpp"

namespace hypotrack::hands {
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

Eigen::Matrix3Xd HandModel::in_model_order(const Eigen::Matrix<double, 3, 21>& detected,
                                           Eigen::Index count) const {
  Eigen::Matrix3Xd out =
      Eigen::Matrix3Xd::Constant(3, count, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    if (landmarks[i] >= 0) out.col(landmarks[i]) = detected.col(static_cast<Eigen::Index>(i));
  return out;
}

std::optional<HandModel> hand_model(const Model& model) {
  constexpr std::ptrdiff_t kLeast = 11;
  HandModel out;
  const auto& names = model.data().landmarks;
  for (std::size_t i = 0; i < kHandPointNames.size(); ++i) {
    const auto found =
        std::ranges::find_if(names, [&](const auto& l) { return l.name == kHandPointNames[i]; });
    out.landmarks[i] = found == names.end() ? -1 : found - names.begin();
  }
  for (const std::size_t i : {kWrist, kIndexKnuckle, kMiddleTip, kLittleKnuckle})
    if (out.landmarks[i] < 0) return std::nullopt;
  if (std::ranges::count_if(out.landmarks, [](Eigen::Index i) { return i >= 0; }) < kLeast)
    return std::nullopt;
  // Fingers bend to the palm's side, which tells a right hand from a left one.
  const Eigen::Matrix3Xd rest = bent(model, 0), grip = bent(model, 0.3);
  const auto at = [&](std::size_t i) -> Eigen::Vector3d { return rest.col(out.landmarks[i]); };
  const Eigen::Vector3d bend =
      grip.col(out.landmarks[kMiddleTip]) - rest.col(out.landmarks[kMiddleTip]);
  const Eigen::Vector3d across =
      (at(kIndexKnuckle) - at(kWrist)).cross(at(kLittleKnuckle) - at(kWrist));
  const double side = across.dot(bend);
  if (!(std::abs(side) > 1e-3 * across.norm() * (at(kMiddleTip) - at(kWrist)).norm()))
    return std::nullopt;
  out.right = side > 0;
  return out;
}

}  // namespace hypotrack::hands
