#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "hypotrack/plugin/model.hpp"

namespace hypotrack {

std::vector<Landmark> bounding_box_landmarks(const Eigen::Matrix3Xf& points) {
  if (points.cols() == 0) return {};
  const Eigen::Vector3d low = points.rowwise().minCoeff().cast<double>();
  const Eigen::Vector3d high = points.rowwise().maxCoeff().cast<double>();
  const Eigen::Vector3d center = (low + high) / 2;
  const Eigen::Vector3d half = (high - low) / 2;
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return half[a] > half[b]; });

  std::vector<Landmark> anchors{{"center", 0, center}};
  for (const int axis : {order[0], order[1]}) {
    Landmark end{std::string("end_") + "xyz"[axis], 0, center};
    end.position[axis] += half[axis];
    anchors.push_back(std::move(end));
  }
  return anchors;
}

ModelData rigid_model(Mesh mesh, std::vector<Landmark> landmarks) {
  ModelData data;
  const Eigen::Index vertices = mesh.vertices.cols();
  mesh.bone_indices = Eigen::Matrix4Xi::Zero(4, vertices);
  mesh.bone_weights = Eigen::Matrix4Xf::Zero(4, vertices);
  mesh.bone_weights.row(0).setOnes();
  data.landmarks = landmarks.empty() ? bounding_box_landmarks(mesh.vertices) : std::move(landmarks);
  data.mesh = std::move(mesh);
  data.bones = {{"object", -1, Eigen::Isometry3d::Identity()}};
  data.parameters = pose_parameters();
  return data;
}

}  // namespace hypotrack
