#include "hypotrack/pose.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "hypotrack/error.hpp"
#include "hypotrack/params.hpp"
#include "session/hand_rotation.hpp"

namespace hypotrack {
namespace {

struct PoseParams {
  std::vector<double> position, rotation, quaternion;
  ConfigNode directions, angles;
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
      {.help = "{palm, fingers}, instead of rotation_deg: where a hand's palm and fingers point"});
    v("angles_deg", angles, {.help = "joint angles by name", .unit = "deg"});
  }
};

/// The angles of one model in degrees, with the model's names and bounds.
struct Angles {
  struct Angle {
    double value = 0;
    std::string name;
    double lower = 0, upper = 0;  // degrees
  };
  std::vector<Angle> all;
  void visit(ParamVisitor& v) {
    for (Angle& a : all)
      v(a.name, a.value,
        {.help = "joint angle", .min = a.lower, .max = a.upper, .unit = "deg", .to_si = kDegree});
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
    q = read_hand_rotation(pose.directions, item, cameras);
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

}  // namespace

void read_angles(const ConfigNode& node, const Scene::Item& item,
                 Eigen::Ref<Eigen::VectorXd> state) {
  Angles angles;
  const auto& parameters = item.model->data().parameters;
  for (std::size_t i = kPoseSize; i < parameters.size(); ++i)
    angles.all.push_back({state[item.offset + static_cast<int>(i)], parameters[i].name,
                          parameters[i].lower / kDegree, parameters[i].upper / kDegree});
  angles = ParamReader(node).read(std::move(angles));
  for (std::size_t i = kPoseSize; i < parameters.size(); ++i)
    state[item.offset + static_cast<int>(i)] = angles.all[i - 7].value;
}

std::string pose_yaml(const Scene& scene, const Eigen::VectorXd& state,
                      const std::vector<bool>& models) {
  constexpr double kAtRest = 1e-3;  // degrees
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
    std::string angles;
    const auto& parameters = item.model->data().parameters;
    for (std::size_t i = kPoseSize; i < parameters.size(); ++i) {
      const Parameter& p = parameters[i];
      const double value = part[static_cast<Eigen::Index>(i)] / kDegree;
      if (std::abs(value - p.rest / kDegree) < kAtRest) continue;
      const double rounded = std::round(value * 1e4) / 1e4;
      angles += fmt::format("    {}: {}\n", p.name,
                            std::clamp(rounded, p.lower / kDegree, p.upper / kDegree));
    }
    if (!angles.empty()) out += "  angles_deg:\n" + angles;
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
    if (pose.angles.defined()) read_angles(pose.angles, item, base);
  }
  return base;
}

}  // namespace hypotrack
