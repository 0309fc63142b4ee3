#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>

#include "hypotrack/api/scene.hpp"
#include "tile/tiles.hpp"

namespace hypotrack::test {

/// A scene of one box of the given size (metres) around its own origin.
inline Scene box_scene(const Eigen::Vector3f& size) {
  Mesh mesh;
  mesh.vertices.resize(3, 8);
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.col(i) =
        0.5f * size.cwiseProduct(Eigen::Vector3f(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  }
  mesh.triangles.resize(3, 12);
  mesh.triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1,  //
      3, 2, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,                //
      1, 3, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
  mesh.bone_indices = Eigen::Matrix4Xi::Zero(4, 8);
  mesh.bone_weights = Eigen::Matrix4Xf::Zero(4, 8);
  mesh.bone_weights.row(0).setOnes();
  return Scene({{"box", std::make_shared<Model>(rigid_model(mesh))}});
}

inline Eigen::VectorXd at(double x, double y, double z) {
  Eigen::VectorXd state(7);
  state << x, y, z, 1, 0, 0, 0;
  return state;
}

inline Eigen::Vector2d project(const TileCamera& camera, const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p = camera.camera_from_world * p_world;
  return {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
}

inline cv::Mat black(const Camera& camera) {
  return cv::Mat::zeros(camera.height, camera.width, CV_8UC3);
}

/// A view of a pinhole camera and a box that makes a tile `scale` times coarser than the image.
struct PlainSetup {
  PlainSetup(double scale, int size)
      : scene(box_scene(Eigen::Vector3f(1, 1, 1e-6f) * static_cast<float>(scale * size / 700))) {
    camera.width = 1280;
    camera.height = 720;
    camera.fx = camera.fy = 700;
    camera.cx = 640 - 0.5;
    camera.cy = 360 - 0.5;
    settings = {.size = size, .padding = 0};
  }
  Observation make(const cv::Mat& image, const Eigen::VectorXd& state = at(0, 0, 1),
                   const cv::Mat& mask = {}) const {
    Frame frame;
    frame.index = 7;
    frame.time = 0.25;
    frame.views = {{image, mask}};
    return TileMaker(scene, {camera}, settings).make(frame, state);
  }
  Scene scene;
  Camera camera;
  TileSettings settings;
};

}  // namespace hypotrack::test
