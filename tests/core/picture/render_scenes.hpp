#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <utility>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack::test {

/// A parallelogram with corners center ± u ± v. Texture: u to the right, v upwards.
inline Mesh parallelogram(const Eigen::Vector3d& center, const Eigen::Vector3d& u,
                          const Eigen::Vector3d& v) {
  Mesh mesh;
  mesh.vertices.resize(3, 4);
  mesh.vertices.col(0) = (center - u - v).cast<float>();
  mesh.vertices.col(1) = (center + u - v).cast<float>();
  mesh.vertices.col(2) = (center + u + v).cast<float>();
  mesh.vertices.col(3) = (center - u + v).cast<float>();
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 0, 1, 2, 2, 3;
  mesh.uv.resize(2, 4);
  mesh.uv << 0, 1, 1, 0, 0, 0, 1, 1;
  mesh.uv_triangles = mesh.triangles;
  mesh.bone_indices = Eigen::Matrix4Xi::Zero(4, 4);
  mesh.bone_weights = Eigen::Matrix4Xf::Zero(4, 4);
  mesh.bone_weights.row(0).setOnes();
  return mesh;
}

/// A disc facing along z.
inline Mesh disc(const Eigen::Vector3d& center, double radius) {
  constexpr int kSides = 64;
  Mesh mesh;
  mesh.vertices.resize(3, kSides);
  mesh.triangles.resize(3, kSides - 2);
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * M_PI * i / kSides;
    mesh.vertices.col(i) =
        (center + radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0)).cast<float>();
    if (i >= 2) mesh.triangles.col(i - 2) << 0, i, i - 1;
  }
  mesh.bone_indices = Eigen::Matrix4Xi::Zero(4, kSides);
  mesh.bone_weights = Eigen::Matrix4Xf::Zero(4, kSides);
  mesh.bone_weights.row(0).setOnes();
  return mesh;
}

/// A box about the origin with its faces seen counter-clockwise from outside.
inline Mesh box(const Eigen::Vector3f& half) {
  Mesh mesh;
  mesh.vertices.resize(3, 8);
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.col(i) = half.cwiseProduct(
        Eigen::Vector3f(i & 1 ? 1.F : -1.F, i & 2 ? 1.F : -1.F, i & 4 ? 1.F : -1.F));
  }
  mesh.triangles.resize(3, 12);
  mesh.triangles.transpose() << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7,
      3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5;
  mesh.bone_indices = Eigen::Matrix4Xi::Zero(4, 8);
  mesh.bone_weights = Eigen::Matrix4Xf::Zero(4, 8);
  mesh.bone_weights.row(0).setOnes();
  return mesh;
}

inline Scene scene_of(std::vector<Mesh> meshes) {
  std::vector<std::pair<std::string, std::shared_ptr<const Model>>> models;
  for (Mesh& mesh : meshes) {
    models.emplace_back("model_" + std::to_string(models.size()),
                        std::make_shared<Model>(rigid_model(std::move(mesh))));
  }
  return Scene(std::move(models));
}

/// A camera at the world's origin looking along z.
inline Camera camera_at_origin(int width = 320, int height = 240, double focal = 300) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = focal;
  camera.fy = 1.02 * focal;
  camera.cx = 0.5 * width - 3.25;
  camera.cy = 0.5 * height + 1.75;
  return camera;
}

/// Point at depth z that a pinhole camera sees at a pixel.
inline Eigen::Vector3d point_at(const Camera& camera, double x, double y, double z) {
  return camera.camera_from_world.inverse() *
         Eigen::Vector3d((x - camera.cx) / camera.fx * z, (y - camera.cy) / camera.fy * z, z);
}

/// Bounds of what is not zero, and its centre of mass.
struct Spot {
  cv::Rect box;
  Eigen::Vector2d centroid;
};
inline Spot spot(const cv::Mat& label, int value = 1) {
  Eigen::AlignedBox2i box;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (int y = 0; y < label.rows; ++y) {
    for (int x = 0; x < label.cols; ++x) {
      if (label.at<unsigned char>(y, x) != value) continue;
      box.extend(Eigen::Vector2i(x, y));
      sum += Eigen::Vector2d(x, y);
      ++count;
    }
  }
  if (count == 0) return {{}, Eigen::Vector2d::Constant(-1)};
  return {{box.min().x(), box.min().y(), box.sizes().x() + 1, box.sizes().y() + 1}, sum / count};
}

}  // namespace hypotrack::test
