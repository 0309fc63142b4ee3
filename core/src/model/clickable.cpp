#include <fmt/format.h>

#include <memory>
#include <utility>

#include "hypotrack/api/clicks.hpp"

namespace hypotrack {

std::shared_ptr<const Model> clickable(const std::shared_ptr<const Model>& model) {
  constexpr float kAtCorner = 1e-4F;  // metres
  if (model->poses_itself() || model->dimension() != kPoseSize) return model;
  ModelData data = model->data();
  const Eigen::Matrix3Xf& vertices = data.mesh.vertices;
  const Eigen::Vector3f low = vertices.rowwise().minCoeff(), high = vertices.rowwise().maxCoeff();
  for (const int x : {0, 1})
    for (const int y : {0, 1})
      for (const int z : {0, 1}) {
        const Eigen::Vector3f corner(x ? high.x() : low.x(), y ? high.y() : low.y(),
                                     z ? high.z() : low.z());
        if ((vertices.colwise() - corner).colwise().norm().minCoeff() > kAtCorner) return model;
        data.landmarks.push_back({fmt::format("corner_{}{}{}", x, y, z), 0, corner.cast<double>()});
      }
  return std::make_shared<Model>(std::move(data));
}

int clicks_needed(const Model& model) { return model.dimension() == kPoseSize ? 3 : 4; }

}  // namespace hypotrack
