#include "track/search/displace.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "hypotrack/plugin/random.hpp"

namespace hypotrack::internal {
namespace {

/// Returns a random direction for (seed, model, purpose): three normal numbers have no preferred
/// one.
Eigen::Vector3d direction(std::uint64_t seed, std::uint32_t model, std::uint32_t purpose) {
  Eigen::Vector3d v;
  for (std::uint32_t i = 0; i < 3; ++i) {
    v[i] = normal(seed, {.dimension = i, .particle = model, .stream = purpose});
  }
  return v.normalized();
}

void displace_angles(const Scene& scene, Eigen::VectorXd& state, double deviation,
                     std::uint64_t seed) {
  const auto& parameters = scene.parameters();
  for (std::uint32_t i = 0; i < parameters.size(); ++i) {
    const Parameter& p = parameters[i];
    if (p.kind != ParameterKind::angle) continue;
    const double x = state[i] + deviation * normal(seed, {.dimension = i, .stream = 2});
    state[i] = std::clamp(x, p.lower, p.upper);
  }
}

}  // namespace

Eigen::VectorXd displaced(const Scene& scene, Eigen::VectorXd state, const Displacement& by,
                          std::uint64_t seed) {
  std::uint32_t model = 0;
  for (const Scene::Item& item : scene.items()) {
    auto pose = state.segment<7>(item.offset);
    const Eigen::Quaterniond rotation(pose[3], pose[4], pose[5], pose[6]);
    const Eigen::Quaterniond turned =
        rotation * Eigen::AngleAxisd(by.radians, direction(seed, model, 1));
    pose.head<3>() += by.metres * direction(seed, model, 0);
    pose.tail<4>() << turned.w(), turned.x(), turned.y(), turned.z();
    ++model;
  }
  if (by.angles > 0) displace_angles(scene, state, by.angles, seed);
  return state;
}

}  // namespace hypotrack::internal
