#include "hypotrack/api/pose.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "config/read_value.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/api/text.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {
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

/// Reads where two of a model's directions() point, `{NAME: DIRECTION, NAME: DIRECTION}`, and
/// returns its rotation (world_from_model). A DIRECTION is [x, y, z] in the world or a word:
/// to_camera, away, left, right, up, down, as seen from the first camera (none: along the world's
/// axes). Throws ConfigError if the model has no such directions or they are given more than 30
/// degrees from perpendicular.
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

struct PoseParams {
  std::vector<double> position, rotation, quaternion;
  ConfigNode directions, angles, lengths;
  void visit(ParamVisitor& v) {
    v("position_mm", position,
      {.help = "x y z in the world", .min = -1e6, .max = 1e6, .unit = "mm", .to_si = kMillimetre});
    v("rotation_deg", rotation,
      {.help = "rotation vector: axis times angle",
       .min = -1e6,
       .max = 1e6,
       .unit = "deg",
       .to_si = kDegree});
    v("quaternion", quaternion,
      {.help = "w x y z, instead of rotation_deg", .min = -1e6, .max = 1e6});
    v("rotation", directions,
      {.help = "instead of rotation_deg: where two directions of the model point, by its names"});
    v("angles_deg", angles, {.help = "joint angles by name", .unit = "deg"});
    v("lengths_mm", lengths, {.help = "how far joints slide, by name", .unit = "mm"});
  }
};

/// A kind of joint: its key in a pose and its unit there.
struct JointKey {
  ParameterKind kind;
  const char* key;
  const char* help;
  const char* unit;
  double to_si;
};
constexpr JointKey kAngles{ParameterKind::angle, "angles_deg", "joint angle", "deg", kDegree};
constexpr JointKey kLengths{ParameterKind::length, "lengths_mm", "length of a joint that slides",
                            "mm", kMillimetre};

/// The joints of one model and kind, with the model's names and bounds.
struct Joints {
  struct Joint {
    int index = 0;  // in the model's parameters
    double value = 0;
    std::string name;
    double lower = 0, upper = 0;  // in the key's unit
  };
  const JointKey& key;
  std::vector<Joint> all;
  void visit(ParamVisitor& v) {
    for (Joint& j : all)
      v(j.name, j.value,
        {.help = key.help, .min = j.lower, .max = j.upper, .unit = key.unit, .to_si = key.to_si});
  }
};

void expect_length(const ConfigNode& node, const char* key, const std::vector<double>& values,
                   std::size_t length) {
  if (!node.get(key).defined() || values.size() == length) return;
  throw ConfigError(fmt::format("{}: {} has {} numbers, expected {}", node.get(key).where(), key,
                                values.size(), length));
}

void apply_rotation(const ConfigNode& node, const PoseParams& pose, const Scene::Item& item,
                    std::span<const Camera> cameras, Eigen::Ref<Eigen::VectorXd> part) {
  std::vector<std::string> given;
  for (const char* key : {"rotation_deg", "quaternion", "rotation"})
    if (node.get(key).defined()) given.emplace_back(key);
  if (given.size() > 1)
    throw ConfigError(fmt::format("{}: both {} and {} are given; leave one out", node.where(),
                                  given[0], given[1]));
  Eigen::Quaterniond q(part[3], part[4], part[5], part[6]);
  if (!pose.quaternion.empty()) {
    q = {pose.quaternion[0], pose.quaternion[1], pose.quaternion[2], pose.quaternion[3]};
    if (q.norm() < 1e-6)
      throw ConfigError(
          fmt::format("{}: a quaternion of zeros is no rotation; 1 0 0 0 is the "
                      "identity",
                      node.get("quaternion").where()));
  } else if (!pose.rotation.empty()) {
    const Eigen::Vector3d v(pose.rotation[0], pose.rotation[1], pose.rotation[2]);
    q = v.norm() > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(v.norm(), v.normalized()))
                     : Eigen::Quaterniond::Identity();
  } else if (pose.directions.defined()) {
    q = rotation_by_directions(pose.directions, item, cameras);
  }
  q.normalize();
  part.segment<4>(3) << q.w(), q.x(), q.y(), q.z();
}

const Scene::Item& find_item(const Scene& scene, const std::string& name, const ConfigNode& where) {
  std::string known;
  for (const auto& item : scene.items()) {
    if (item.name == name) return item;
    known += (known.empty() ? "" : ", ") + item.name;
  }
  throw ConfigError(fmt::format("{}: '{}' is no model of this scene; its models are: {}",
                                where.where(), name, known));
}

/// Sets joints of a kind from a map of names to numbers.
void apply_joints(const ConfigNode& node, const JointKey& key, const Scene::Item& item,
                  Eigen::Ref<Eigen::VectorXd> part) {
  if (!node.defined()) return;
  Joints joints{key, {}};
  const auto& parameters = item.model->data().parameters;
  for (int i = kPoseSize; i < item.model->dimension(); ++i) {
    const Parameter& p = parameters[static_cast<std::size_t>(i)];
    if (p.kind == key.kind)
      joints.all.push_back({i, part[i], p.name, p.lower / key.to_si, p.upper / key.to_si});
  }
  for (const Joints::Joint& joint : ParamReader(node).read(joints).all)
    part[joint.index] = joint.value;
}

/// Returns the joints of a kind that are not at rest, as a map below their key.
std::string joints_yaml(const JointKey& key, const Scene::Item& item,
                        const Eigen::Ref<const Eigen::VectorXd>& part) {
  constexpr double kAtRest = 1e-3;  // degrees or millimetres
  std::string out;
  for (int i = kPoseSize; i < item.model->dimension(); ++i) {
    const Parameter& p = item.model->data().parameters[static_cast<std::size_t>(i)];
    const double value = part[i] / key.to_si;
    if (p.kind != key.kind || std::abs(value - p.rest / key.to_si) < kAtRest) continue;
    const double rounded = std::round(value * 1e4) / 1e4;
    out += fmt::format("    {}: {}\n", p.name,
                       std::clamp(rounded, p.lower / key.to_si, p.upper / key.to_si));
  }
  return out.empty() ? out : fmt::format("  {}:\n{}", key.key, out);
}

}  // namespace

std::string pose_yaml(const Scene& scene, const Eigen::VectorXd& state,
                      const std::vector<bool>& models) {
  std::string out;
  for (std::size_t m = 0; m < scene.items().size(); ++m) {
    if (!models[m]) continue;
    const Scene::Item& item = scene.items()[m];
    const auto part = state.segment(item.offset, item.model->dimension());
    out += fmt::format(
        "{}:\n  position_mm: [{:.4f}, {:.4f}, {:.4f}]\n  quaternion: [{:.8f}, {:.8f}, {:.8f}, "
        "{:.8f}]\n",
        item.name, part[0] / kMillimetre, part[1] / kMillimetre, part[2] / kMillimetre, part[3],
        part[4], part[5], part[6]);
    for (const JointKey& key : {kAngles, kLengths}) out += joints_yaml(key, item, part);
  }
  return out;
}

Eigen::VectorXd read_pose(const ConfigNode& node, const Scene& scene, Eigen::VectorXd base,
                          std::span<const Camera> cameras) {
  if (!node.is_map())
    throw ConfigError(fmt::format("{}: expected a map of model names to poses", node.where()));
  for (const std::string& name : node.keys()) {
    const ConfigNode value = node.get(name);
    const Scene::Item& item = find_item(scene, name, value);
    const auto pose = ParamReader(value).read<PoseParams>();
    expect_length(value, "position_mm", pose.position, 3);
    expect_length(value, "rotation_deg", pose.rotation, 3);
    expect_length(value, "quaternion", pose.quaternion, 4);
    auto part = base.segment(item.offset, item.model->dimension());
    if (!pose.position.empty())
      part.head<3>() << pose.position[0], pose.position[1], pose.position[2];
    apply_rotation(value, pose, item, cameras, part);
    apply_joints(pose.angles, kAngles, item, part);
    apply_joints(pose.lengths, kLengths, item, part);
  }
  return base;
}

}  // namespace hypotrack
