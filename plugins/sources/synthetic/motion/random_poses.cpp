#include "motion/random_poses.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/pose.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "motion/keyframes.hpp"

namespace hypotrack::synthetic {
namespace {

std::size_t model_of(const std::string& name, const ConfigNode& where, const Scene& scene) {
  std::vector<std::string> known;
  for (const Scene::Item& item : scene.items()) {
    if (item.name == name) return known.size();
    known.push_back(item.name);
  }
  throw ConfigError(fmt::format("{}: '{}' is no model of this scene; its models are: {}",
                                where.where(), name, fmt::join(known, ", ")));
}

Eigen::Isometry3d pose_of(const Scene& scene, std::size_t model, const Eigen::VectorXd& state) {
  return world_from_model(scene.part(scene.items()[model], state));
}

void set_rotation(const Scene::Item& item, const Eigen::Quaterniond& q, Eigen::VectorXd& state) {
  state.segment<4>(item.offset + 3) << q.w(), q.x(), q.y(), q.z();
}

}  // namespace

Eigen::Quaterniond rotation_of(const Scene::Item& item, const Eigen::VectorXd& state) {
  const auto q = state.segment<4>(item.offset + 3);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

RandomPoses::RandomPoses(const RandomParams& params, const ConfigNode& node,
                         const Gestures& gestures, const Scene& scene,
                         const std::vector<Camera>& cameras)
    : params_(params),
      node_(node),
      scene_(scene),
      cameras_(cameras),
      random_(static_cast<std::uint64_t>(params.seed) * 7907 + 11) {
  read_gestures(gestures);
  read_holds();
  for (int i = 0; i < 16; ++i) random_.next();  // similar seeds begin alike
}

void RandomPoses::read_gestures(const Gestures& gestures) {
  const ConfigNode& said = params_.gestures;
  if (said.defined() && (!said.is_list() || said.size() == 0))
    throw ConfigError(said.where() + ": expected a list of names of gestures");
  std::vector<std::pair<std::string, ConfigNode>> names;
  for (std::size_t i = 0; i < said.size(); ++i) {
    if (!said.at(i).is_scalar())
      throw ConfigError(said.at(i).where() + ": expected the name of a gesture");
    names.emplace_back(said.at(i).scalar(), said.at(i));
  }
  if (!said.defined())
    for (const std::string& name : gestures.names()) names.emplace_back(name, node_);
  if (names.empty()) names.emplace_back("rest", node_);
  for (const Scene::Item& item : scene_.items()) {
    std::vector<std::vector<double>>& of_model = gestures_.emplace_back();
    if (item.model->dimension() > kPoseSize)
      for (const auto& [name, where] : names)
        of_model.push_back(gestures.parameters(name, where, item));
  }
  last_.resize(scene_.items().size());
}

void RandomPoses::read_holds() {
  const ConfigNode& holds = params_.hold;
  if (holds.defined() && !holds.is_map())
    throw ConfigError(holds.where() + ": expected a map of models to the model that holds them");
  Eigen::VectorXd posed = scene_.rest_state();
  if (params_.pose.defined()) posed = read_pose(params_.pose, scene_, std::move(posed));
  for (const std::string& name : holds.keys()) {
    const ConfigNode said = holds.get(name);
    if (!said.is_scalar()) throw ConfigError(said.where() + ": expected the name of a model");
    const std::size_t model = model_of(name, said, scene_);
    const std::size_t holder = model_of(said.scalar(), said, scene_);
    if (model == holder || holds.get(said.scalar()).defined())
      throw ConfigError(fmt::format("{}: '{}' cannot hold '{}': what holds must not be held itself",
                                    said.where(), said.scalar(), name));
    held_.push_back(
        {model, holder, pose_of(scene_, holder, posed).inverse() * pose_of(scene_, model, posed)});
  }
}

bool RandomPoses::is_held(std::size_t model) const {
  return std::any_of(held_.begin(), held_.end(),
                     [&](const Held& held) { return held.model == model; });
}

void RandomPoses::fail() const {
  throw ConfigError(fmt::format(
      "{}: found no motion between lowest_mm and highest_mm that shows the models as a whole in "
      "all pictures, {:.6g} mm apart; change the box, which is in world axes, or apart_mm",
      node_.where(), params_.apart / kMillimetre));
}

Eigen::VectorXd RandomPoses::draw() {
  constexpr int kTries = 20000;
  const std::vector<std::size_t> before = last_;
  for (int i = 0; i < kTries; ++i) {
    Eigen::VectorXd state = scene_.rest_state();
    last_ = before;
    for (std::size_t m = 0; m < gestures_.size(); ++m) place(m, state);
    place_held(state);
    if (is_good(state)) return state;
  }
  fail();
}

void RandomPoses::place(std::size_t model, Eigen::VectorXd& state) {
  const Scene::Item& item = scene_.items()[model];
  if (const auto& gestures = gestures_[model]; !gestures.empty()) {
    const auto count = static_cast<int>(gestures.size());
    const int step = count > 1 ? random_.uniform(1, count) : 0;
    last_[model] = (last_[model] + static_cast<std::size_t>(step)) % gestures.size();
    const std::vector<double>& parameters = gestures[last_[model]];
    for (std::size_t i = kPoseSize; i < parameters.size(); ++i)
      state[item.offset + static_cast<int>(i)] = parameters[i];
  }
  if (is_held(model)) return;
  for (int axis = 0; axis < 3; ++axis)
    state[item.offset + axis] =
        params_.lowest[axis] + random_.uniform(0.0, 1.0) * (params_.highest - params_.lowest)[axis];
  set_rotation(item, draw_rotation(), state);
}

void RandomPoses::place_held(Eigen::VectorXd& state) const {
  for (const Held& held : held_) {
    const Eigen::Isometry3d pose = pose_of(scene_, held.holder, state) * held.holder_from_model;
    const Scene::Item& item = scene_.items()[held.model];
    state.segment<3>(item.offset) = pose.translation();
    set_rotation(item, Eigen::Quaterniond(pose.linear()), state);
  }
}

/// Draws a rotation. A facing hand is rolled in the picture, shows palm or back, and is then
/// tilted.
Eigen::Quaterniond RandomPoses::draw_rotation() {
  constexpr double kTurn = 2 * std::numbers::pi;
  if (params_.rotation == RandomRotation::any) {
    const Eigen::Vector4d q(random_.gaussian(1), random_.gaussian(1), random_.gaussian(1),
                            random_.gaussian(1));
    return Eigen::Quaterniond(q).normalized();
  }
  const auto about = [](double angle, const Eigen::Vector3d& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
  };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), z = Eigen::Vector3d::UnitZ();
  const bool palm = random_.uniform(0.0, 1.0) < 0.5;
  const double roll = random_.uniform(-0.25, 0.25) * kTurn;
  const double tilt = std::acos(random_.uniform(std::cos(params_.tilt), 1.0));
  const double direction = random_.uniform(0.0, 1.0) * kTurn;
  const Eigen::Vector3d axis(std::cos(direction), std::sin(direction), 0);
  return about(tilt, axis) * about(roll, z) * (palm ? about(kTurn / 2, x) : about(kTurn / 2, z));
}

bool RandomPoses::is_good(const Eigen::VectorXd& state) const {
  return keep_apart(state) && std::all_of(scene_.items().begin(), scene_.items().end(),
                                          [&](const auto& item) { return is_seen(item, state); });
}

/// Returns whether all cameras see a model: landmarks with flesh around them if it has joints,
/// otherwise all vertices.
bool RandomPoses::is_seen(const Scene::Item& item, const Eigen::VectorXd& state) const {
  constexpr double kFlesh = 0.02;
  const std::span<const double> part = scene_.part(item, state);
  const bool rigid = item.model->dimension() == kPoseSize;
  const Eigen::Matrix3Xd points = rigid ? posed_vertices(*item.model, part).cast<double>().eval()
                                        : posed_landmarks(*item.model, part);
  for (const Camera& camera : cameras_) {
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const Eigen::Vector2d pixel = project(camera, points.col(i));
      const double z = (camera.camera_from_world * points.col(i)).z();
      const double margin = rigid ? 0 : kFlesh * camera.fx / z;
      if (!(pixel.x() >= margin && pixel.x() <= camera.width - 1 - margin && pixel.y() >= margin &&
            pixel.y() <= camera.height - 1 - margin))  // true for NaN
        return false;
    }
  }
  return true;
}

bool RandomPoses::keep_apart(const Eigen::VectorXd& state) const {
  const std::vector<Scene::Item>& items = scene_.items();
  for (std::size_t a = 0; a < items.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (!is_held(a) && !is_held(b) &&
          (state.segment<3>(items[a].offset) - state.segment<3>(items[b].offset)).norm() <
              params_.apart)
        return false;
  return true;
}

}  // namespace hypotrack::synthetic
