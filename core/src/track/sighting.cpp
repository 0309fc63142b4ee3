#include "track/sighting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::internal {

double landmark_distance(const Model& model, std::span<const double> a, std::span<const double> b) {
  const Eigen::Matrix3Xd apart = posed_landmarks(model, a) - posed_landmarks(model, b);
  return apart.cols() > 0 ? apart.colwise().norm().mean() : 0;
}

Eigen::Vector3d landmark_center(const Model& model, const Eigen::VectorXd& pose) {
  return posed_landmarks(model, {pose.data(), static_cast<std::size_t>(pose.size())})
      .rowwise()
      .mean();
}

void check_proposal(const Scene::Item& item, const Eigen::VectorXd& parameters) {
  const Eigen::Index size = item.model->dimension();
  if (parameters.size() != size || !parameters.allFinite() ||
      std::abs(parameters.segment<4>(3).norm() - 1) > 1e-6)
    throw PluginError(
        fmt::format("a starter proposes a pose of '{}' with {} parameters; expected {} finite ones "
                    "and a unit quaternion; this is a bug in the starter",
                    item.name, parameters.size(), size));
}

std::optional<double> Sighting::distance(const Model& model, std::span<const double> pose) const {
  std::optional<double> nearest;
  for (const Eigen::VectorXd& seen : poses) {
    const double apart =
        landmark_distance(model, pose, {seen.data(), static_cast<std::size_t>(seen.size())});
    nearest = std::min(nearest.value_or(apart), apart);
  }
  return nearest;
}

Sighting sighting(const std::vector<std::unique_ptr<Starter>>& starters, const Scene& scene,
                  const std::vector<Camera>& cameras, const Frame& frame, std::size_t model) {
  const Scene::Item& item = scene.items().at(model);
  const StarterContext context{
      .scene = scene, .cameras = cameras, .frame = &frame, .sure_only = true};
  Sighting out;
  for (const std::unique_ptr<Starter>& starter : starters) {
    if (!starter->detects(model)) continue;
    out.asked = true;
    starter->find(context, model, [&](const Eigen::VectorXd& parameters) {
      check_proposal(item, parameters);
      out.poses.push_back(parameters);
      return true;
    });
  }
  return out;
}

}  // namespace hypotrack::internal
