#include "track/recover/held_models.hpp"

#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::internal {
namespace {

Eigen::Matrix3Xd landmarks_of(const Scene& scene, std::size_t model, const Eigen::VectorXd& state) {
  const Scene::Item& item = scene.items()[model];
  return posed_landmarks(*item.model, scene.part(item, state));
}

/// Returns the largest distance of a landmark from their centre.
double reach_of(const Eigen::Matrix3Xd& landmarks) {
  const Eigen::Vector3d center = landmarks.rowwise().mean();
  return (landmarks.colwise() - center).colwise().norm().maxCoeff();
}

}  // namespace

Eigen::VectorXd moved_with(const Scene& scene, std::size_t model, std::size_t other,
                           const Eigen::VectorXd& before, const Eigen::VectorXd& now) {
  const Scene::Item &own = scene.items()[model], &at = scene.items()[other];
  Eigen::VectorXd out = before;
  set_pose(own, pose_of(at, now) * pose_of(at, before).inverse() * pose_of(own, before), out);
  return out;
}

std::vector<bool> held_by(const Scene& scene, std::size_t model, const Eigen::VectorXd& state) {
  std::vector<bool> out(scene.items().size(), false);
  if (is_rigid(scene.items()[model])) return out;
  const Eigen::Matrix3Xd own = landmarks_of(scene, model, state);
  for (std::size_t m = 0; m < out.size(); ++m) {
    if (!is_rigid(scene.items()[m])) continue;
    const Eigen::Matrix3Xd other = landmarks_of(scene, m, state);
    out[m] =
        (own.rowwise().mean() - other.rowwise().mean()).norm() < reach_of(own) + reach_of(other);
  }
  return out;
}

double moved_while_held(const Scene& scene, const Eigen::VectorXd& before,
                        const Eigen::VectorXd& now, const std::vector<bool>& shown) {
  double sum = 0;
  for (std::size_t by = 0; by < shown.size(); ++by) {
    if (!shown[by]) continue;
    const std::vector<bool> held = held_by(scene, by, before);
    for (std::size_t m = 0; m < shown.size(); ++m) {
      if (!held[m] || !shown[m]) continue;
      const Eigen::VectorXd kept = moved_with(scene, m, by, before, now);
      sum += (landmarks_of(scene, m, kept) - landmarks_of(scene, m, now)).colwise().norm().mean();
    }
  }
  return sum;
}

}  // namespace hypotrack::internal
