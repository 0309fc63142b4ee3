#include "hand_model.hpp"

#include <algorithm>
#include <limits>

#include "palm.hpp"

namespace hypotrack {

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
  HandModel out;
  const auto& names = model.data().landmarks;
  for (std::size_t i = 0; i < kHandPointNames.size(); ++i) {
    const auto found = std::ranges::find_if(
        names, [&](const Landmark& l) { return l.name == kHandPointNames[i]; });
    out.landmarks[i] = found == names.end() ? -1 : found - names.begin();
  }
  if (std::ranges::count_if(out.landmarks, [](Eigen::Index i) { return i >= 0; }) < kLeast) {
    return std::nullopt;
  }
  const std::optional<PalmAxes> axes = palm_axes(model);
  if (!axes) return std::nullopt;
  out.right = axes->right;
  return out;
}

}  // namespace hypotrack
