#include "session/rotation_by_directions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "config/read_value.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack::internal {
namespace {

/// Where the directions of a model point, under the model's names.
struct PointedDirections {
  std::vector<NamedDirection> known;
  std::vector<ConfigNode> given = std::vector<ConfigNode>(known.size());
  void visit(ParamVisitor& v) {
    for (std::size_t i = 0; i < known.size(); ++i)
      v(known[i].name, given[i], {.help = "where this direction of the model points"});
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
Eigen::Matrix3d frame_of(const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  const Eigen::Vector3d sum = (second + first).normalized();
  const Eigen::Vector3d difference = (second - first).normalized();
  Eigen::Matrix3d out;
  out.col(0) = (sum - difference).normalized();
  out.col(1) = (sum + difference).normalized();
  out.col(2) = out.col(0).cross(out.col(1));
  return out;
}

/// Returns the two directions that are given, as indices of the known ones.
std::pair<std::size_t, std::size_t> two_of(const PointedDirections& directions,
                                           const ConfigNode& node) {
  std::vector<std::size_t> found;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < directions.known.size(); ++i) {
    names.push_back(directions.known[i].name);
    if (directions.given[i].defined()) found.push_back(i);
  }
  if (found.size() == 2) return {found[0], found[1]};
  detail::fail_at(node, fmt::format("gives {} of the directions {}; expected two", found.size(),
                                    fmt::join(names, ", ")));
}

}  // namespace

Eigen::Quaterniond rotation_by_directions(const ConfigNode& node, const Scene::Item& item,
                                          std::span<const Camera> cameras) {
  constexpr double kMostOff = 30 * kDegree;
  const PointedDirections known{item.model->directions()};
  if (known.known.size() < 2)
    detail::fail_at(node, fmt::format("'{}' has no directions to point by name; give rotation_deg "
                                      "or quaternion instead",
                                      item.name));
  const auto directions = ParamReader(node).read(known);
  const auto [one, other] = two_of(directions, node);
  const Eigen::Matrix3d world_from_camera =
      cameras.empty() ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                      : Eigen::Matrix3d(cameras[0].camera_from_world.linear().transpose());
  const Eigen::Vector3d first = read_direction(directions.given[one], world_from_camera);
  const Eigen::Vector3d second = read_direction(directions.given[other], world_from_camera);
  const NamedDirection &a = directions.known[one], &b = directions.known[other];
  const double angle = std::acos(std::clamp(first.dot(second), -1.0, 1.0));
  if (std::abs(angle - 90 * kDegree) > kMostOff)
    detail::fail_at(node, fmt::format("{} and {} are {:.0f} degrees apart; in the model they are "
                                      "perpendicular: expected 60 to 120 degrees",
                                      a.name, b.name, angle / kDegree));
  const Eigen::Matrix3d world_from_model =
      frame_of(first, second) * frame_of(a.axis, b.axis).transpose();
  return Eigen::Quaterniond(world_from_model).normalized();
}

}  // namespace hypotrack::internal
