#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "test_models.hpp"
#include "tile/tiles.hpp"

namespace hypotrack::test {

/// A grey ball with waves on it, and a highlight, in front of a rectified pair of cameras 12 cm
/// apart.
struct ShinyBall {
  static constexpr double kRadius = 0.05, kFar = 0.5;  // metres

  ShinyBall() {
    Camera camera{640, 480, 500, 500, 319.5, 239.5, DistortionModel::none, {}, {}};
    camera.camera_from_world = Eigen::Isometry3d::Identity();
    cameras = {camera, camera};
    cameras[1].camera_from_world.translation().x() = -0.12;
    tiles = std::make_unique<TileMaker>(scene, cameras, TileSettings{});
  }

  /// Returns the state that the pictures show.
  Eigen::VectorXd state() const {
    Eigen::VectorXd out = scene.rest_state();
    out.head<3>() << 0.06, 0, kFar;
    return out;
  }

  /// Draws pictures with a highlight of `strength`, 0 .. 255, by a light in a direction.
  Frame frame(double strength, const Eigen::Vector3d& light = {-0.4, -0.3, -1}) const {
    Frame out;
    out.views.resize(2);
    for (std::size_t i = 0; i < 2; ++i) {
      cv::Mat3b& picture = reinterpret_cast<cv::Mat3b&>(out.views[i].color);
      picture = cv::Mat3b(cameras[i].height, cameras[i].width, cv::Vec3b(60, 60, 60));
      for (int v = 0; v < picture.rows; ++v)
        for (int u = 0; u < picture.cols; ++u)
          shade(cameras[i], u, v, strength, light.normalized(), picture(v, u));
    }
    return out;
  }

  Scene scene{{{"ball", std::make_shared<Model>(make_test_ball(kRadius))}}};
  std::vector<Camera> cameras;
  std::unique_ptr<TileMaker> tiles;

 private:
  void shade(const Camera& camera, int u, int v, double strength, const Eigen::Vector3d& light,
             cv::Vec3b& pixel) const {
    const Eigen::Vector3d from = camera.camera_from_world.inverse().translation();
    const Eigen::Vector3d ray =
        Eigen::Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1).normalized();
    const Eigen::Vector3d off = from - state().head<3>();
    const double half = ray.dot(off), inside = half * half - off.squaredNorm() + kRadius * kRadius;
    if (inside < 0) return;
    const Eigen::Vector3d at = (-half - std::sqrt(inside)) * ray;
    const Eigen::Vector3d normal = (off + at) / kRadius,
                          middle = (light - at.normalized()).normalized();
    const double wave = 120 + 25 * std::sin(12 * normal.x()) + 25 * std::cos(9 * normal.y());
    const double shine = strength * std::pow(std::max(normal.dot(middle), 0.0), 25);
    pixel = cv::Vec3b::all(cv::saturate_cast<uchar>(wave + shine));
  }
};

}  // namespace hypotrack::test
