#include "depth_range.hpp"

#include <algorithm>
#include <limits>

#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::skin {

DepthRange depth_range(const Observation& observation, const TileCamera& camera, double margin) {
  const Eigen::Isometry3f view = camera.camera_from_world.cast<float>();
  float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
  for (const Scene::Item& item : observation.scene->items()) {
    const Eigen::Matrix3Xf vertices =
        posed_vertices(*item.model, observation.scene->part(item, observation.start));
    const Eigen::RowVectorXf z = (view.linear().row(2) * vertices).array() + view.translation().z();
    nearest = std::min(nearest, z.minCoeff());
    farthest = std::max(farthest, z.maxCoeff());
  }
  return {nearest - static_cast<float>(margin), farthest + static_cast<float>(margin)};
}

}  // namespace hypotrack::skin
