#include "palm.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <string_view>
#include <vector>

#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack {
namespace {

/// Returns the model's landmarks at rest, with every angle moved by a share of the way to its upper
/// bound.
Eigen::Matrix3Xd landmarks_bent(const Model& model, double share) {
  std::vector<double> parameters;
  for (const Parameter& p : model.data().parameters) {
    const bool bends = p.kind == ParameterKind::angle && std::isfinite(p.upper);
    parameters.push_back(bends ? p.rest + share * (p.upper - p.rest) : p.rest);
  }
  return posed_landmarks(model, parameters);
}

/// Returns the index of a landmark; -1: there is none of that name.
Eigen::Index index_of(const Model& model, std::string_view name) {
  const auto& landmarks = model.data().landmarks;
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    if (landmarks[i].name == name) return static_cast<Eigen::Index>(i);
  return -1;
}

}  // namespace

std::optional<PalmAxes> palm_axes(const Model& model) {
  constexpr double kGrip = 0.3, kLeastBend = 1e-3;
  const Eigen::Index wrist = index_of(model, "wrist"), index = index_of(model, "index_mcp"),
                     little = index_of(model, "little_mcp"), tip = index_of(model, "middle_tip");
  if (wrist < 0 || index < 0 || little < 0 || tip < 0) return std::nullopt;
  const Eigen::Matrix3Xd rest = landmarks_bent(model, 0), grip = landmarks_bent(model, kGrip);
  const Eigen::Vector3d to_index = rest.col(index) - rest.col(wrist);
  const Eigen::Vector3d to_little = rest.col(little) - rest.col(wrist);
  const Eigen::Vector3d across = to_index.cross(to_little);
  // Fingers bend to the palm's side, which tells a right hand from a left one.
  const double side = across.dot(grip.col(tip) - rest.col(tip));
  const double length = (rest.col(tip) - rest.col(wrist)).norm();
  if (!(std::abs(side) > kLeastBend * across.norm() * length)) return std::nullopt;
  // Both knuckles lie in the palm's plane, so this is perpendicular to its normal.
  return PalmAxes{across.normalized() * (side > 0 ? 1 : -1), (to_index + to_little).normalized(),
                  side > 0};
}

std::vector<NamedDirection> palm_directions(const Model& model) {
  const std::optional<PalmAxes> axes = palm_axes(model);
  if (!axes) return {};
  return {{"palm", axes->palm}, {"fingers", axes->fingers}};
}

}  // namespace hypotrack
