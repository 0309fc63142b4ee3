#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/pose.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/starter.hpp"
#include "session/opened_scene.hpp"
#include "track/search/displace.hpp"

namespace hypotrack::internal {
namespace {

/// Returns a point about half a metre away that both first cameras see: where their axes are
/// nearest to each other, if they converge.
Eigen::Vector3d point_in_view(const std::vector<Camera>& cameras) {
  constexpr double kDepth = 0.5, kNearest = 0.2, kFarthest = 1.5;  // metres
  std::vector<Eigen::Isometry3d> from_camera;
  for (std::size_t i = 0; i < std::min<std::size_t>(2, cameras.size()); ++i)
    from_camera.push_back(cameras[i].camera_from_world.inverse());
  const auto at = [&](std::size_t i, double depth) {
    return Eigen::Vector3d(from_camera[i] * Eigen::Vector3d(0, 0, depth));
  };
  if (from_camera.size() == 1) return at(0, kDepth);
  const Eigen::Vector3d a = from_camera[0].linear().col(2), b = from_camera[1].linear().col(2);
  const Eigen::Vector3d apart = from_camera[1].translation() - from_camera[0].translation();
  const double turned = 1 - a.dot(b) * a.dot(b);  // squared sine of the angle between the axes
  double depth = kDepth;
  if (turned > 1e-3)
    depth = std::clamp((a - a.dot(b) * b).dot(apart) / turned, kNearest, kFarthest);
  return (at(0, depth) + at(1, depth)) / 2;
}

/// Returns the rest state with the models moved to where both first cameras see them.
Eigen::VectorXd state_in_view(const Scene& scene, const std::vector<Camera>& cameras) {
  Eigen::VectorXd state = scene.rest_state();
  const Eigen::Vector3d point = point_in_view(cameras);
  for (const Scene::Item& item : scene.items()) {
    const Eigen::Matrix3Xd landmarks = posed_landmarks(*item.model, scene.part(item, state));
    if (landmarks.cols() > 0)
      state.segment<3>(item.offset) += point - landmarks.rowwise().mean();
    else
      state.segment<3>(item.offset) = point;
  }
  return state;
}

}  // namespace

std::optional<Eigen::VectorXd> start_state(const OpenedScene& session, const Frame* frame,
                                           std::vector<std::string>* notes) {
  const Scene& scene = *session.scene;
  // A tracker may have taken the parts already.
  const std::vector<Camera>& cameras =
      session.source ? session.source->cameras() : session.parts.cameras;
  if (!session.starter) return state_in_view(scene, cameras);
  std::optional<Eigen::VectorXd> state =
      session.starter->state({.scene = scene, .cameras = cameras, .frame = frame, .notes = notes});
  const InitSettings& init = session.init;
  const std::string who = fmt::format(
      "the starter '{}'", init.from.is_map() ? init.from.get("type").scalar() : init.from.scalar());
  if (!state && frame)
    throw ConfigError(fmt::format("{} gives no state for frame {}; this is a bug in the starter",
                                  who, frame->index));
  if (!state) return state;
  scene.check(*state, who);
  if (init.pose.defined()) state = read_pose(init.pose, scene, *std::move(state), cameras);
  if (init.away == 0 && init.away_turn == 0 && init.away_angles == 0) return state;
  return displaced(scene, *std::move(state), {init.away, init.away_turn, init.away_angles},
                   session.seed);
}

Eigen::VectorXd initial_state(const OpenedScene& session, const Frame& first,
                              std::vector<std::string>* notes) {
  return *start_state(session, &first, notes);
}

}  // namespace hypotrack::internal
