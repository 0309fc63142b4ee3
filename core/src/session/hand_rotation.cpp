#include "session/hand_rotation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "config/read_value.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/params.hpp"
#include "hypotrack/suggest.hpp"
#include "model/palm.hpp"

namespace hypotrack::internal {
namespace {

struct HandDirections {
  ConfigNode palm, fingers;
  void visit(ParamVisitor& v) {
    v("palm", palm, {.help = "where the palm faces", .required = true});
    v("fingers", fingers, {.help = "from the wrist to the knuckles", .required = true});
  }
};

/// Returns a direction in the world, a unit vector.
Eigen::Vector3d read_direction(const ConfigNode& node, const Eigen::Matrix3d& world_from_camera) {
  if (node.is_list()) {
    if (node.size() != 3)
      detail::fail_at(node, fmt::format("has {} numbers, expected 3: x, y, z", node.size()));
    Eigen::Vector3d out;
    for (Eigen::Index i = 0; i < 3; ++i)
      out[i] = detail::read_double(node.at(static_cast<std::size_t>(i)),
                                   {.help = "", .min = -1e6, .max = 1e6});
    if (!(out.norm() > 1e-6)) detail::fail_at(node, "is no direction: all numbers are 0");
    return out.normalized();
  }
  const std::vector<std::pair<std::string, Eigen::Vector3d>> words{
      {"to_camera", {0, 0, -1}}, {"away", {0, 0, 1}}, {"left", {-1, 0, 0}},
      {"right", {1, 0, 0}},      {"up", {0, -1, 0}},  {"down", {0, 1, 0}}};
  std::vector<std::string> names;
  for (const auto& [word, direction] : words) {
    if (node.is_scalar() && node.scalar() == word) return world_from_camera * direction;
    names.push_back(word);
  }
  detail::fail_at(node, fmt::format("found {}; expected [x, y, z] or one of {}{}",
                                    detail::describe_value(node), fmt::join(names, ", "),
                                    node.is_scalar() ? did_you_mean(node.scalar(), names) : ""));
}

/// Returns an orthonormal frame of two directions that are about perpendicular: both are turned by
/// the same angle.
Eigen::Matrix3d frame_of(const Eigen::Vector3d& palm, const Eigen::Vector3d& fingers) {
  const Eigen::Vector3d sum = (fingers + palm).normalized();
  const Eigen::Vector3d difference = (fingers - palm).normalized();
  Eigen::Matrix3d out;
  out.col(0) = (sum - difference).normalized();
  out.col(1) = (sum + difference).normalized();
  out.col(2) = out.col(0).cross(out.col(1));
  return out;
}

}  // namespace

Eigen::Quaterniond read_hand_rotation(const ConfigNode& node, const Scene::Item& item,
                                      std::span<const Camera> cameras) {
  constexpr double kMostOff = 30 * kDegree;
  const std::optional<PalmAxes> axes = palm_axes(*item.model);
  if (!axes)
    detail::fail_at(node,
                    fmt::format("'{}' is no hand with landmarks wrist, index_mcp, little_mcp "
                                "and middle_tip, so that it has no palm; give rotation_deg or "
                                "quaternion instead",
                                item.name));
  const auto given = ParamReader(node).read<HandDirections>();
  const Eigen::Matrix3d world_from_camera =
      cameras.empty() ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                      : Eigen::Matrix3d(cameras[0].camera_from_world.linear().transpose());
  const Eigen::Vector3d palm = read_direction(given.palm, world_from_camera);
  const Eigen::Vector3d fingers = read_direction(given.fingers, world_from_camera);
  const double angle = std::acos(std::clamp(palm.dot(fingers), -1.0, 1.0));
  if (std::abs(angle - 90 * kDegree) > kMostOff)
    detail::fail_at(node, fmt::format("palm and fingers are {:.0f} degrees apart; a palm faces "
                                      "across its fingers: expected 60 to 120 degrees",
                                      angle / kDegree));
  const Eigen::Matrix3d world_from_model =
      frame_of(palm, fingers) * frame_of(axes->palm, axes->fingers).transpose();
  return Eigen::Quaterniond(world_from_model).normalized();
}

}  // namespace hypotrack::internal
