#pragma once

#include <cmath>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "test_models.hpp"
#include "tile/tiles.hpp"

namespace hypotrack::test {

/// A painted box before a rectified pair of cameras, and frames of it. Around the box each view
/// shows noise of its own.
class PaintedBox {
 public:
  static constexpr double kWide = 0.12, kFace = 0.5;  // metres

  /// `wide` and `high` are the edges of its face.
  explicit PaintedBox(double wide = kWide, double high = kWide)
      : scene{{{"box", std::make_shared<Model>(make_test_box({wide, high, 0.02}))}}},
        half_wide_(wide / 2),
        half_high_(high / 2) {
    Camera camera{640, 480, 500, 500, 319.5, 239.5, DistortionModel::none, {}, {}};
    camera.camera_from_world = Eigen::Isometry3d::Identity();
    cameras = {camera, camera};
    cameras[1].camera_from_world.translation().x() = -0.06;
    tiles = std::make_unique<TileMaker>(scene, cameras, TileSettings{});
  }

  /// The box with its face towards the cameras, moved along x.
  Eigen::VectorXd state(double x = 0) const {
    Eigen::VectorXd out = scene.rest_state();
    out.head<3>() << x, 0, kFace + 0.01;
    return out;
  }

  /// A frame in which the second view shows gain * colour + offset.
  Frame frame(double gain = 1, double offset = 0) const {
    Frame out;
    out.views.resize(2);
    cv::RNG random(11);
    for (std::size_t i = 0; i < 2; ++i) {
      out.views[i].color = picture(cameras[i], random);
      if (i == 1) out.views[i].color.convertTo(out.views[i].color, CV_8U, gain, offset);
    }
    return out;
  }

  Scene scene;
  std::vector<Camera> cameras;
  std::unique_ptr<TileMaker> tiles;

 private:
  cv::Mat picture(const Camera& camera, cv::RNG& random) const {
    cv::Mat3b out(camera.height, camera.width);
    random.fill(out, cv::RNG::UNIFORM, 20, 235);
    const double baseline = camera.camera_from_world.translation().x();
    for (int v = 0; v < out.rows; ++v) {
      for (int u = 0; u < out.cols; ++u) {
        const double x = (u - camera.cx) / camera.fx * kFace - baseline;
        const double y = (v - camera.cy) / camera.fy * kFace;
        if (std::abs(x) > half_wide_ || std::abs(y) > half_high_) continue;
        const double wave = std::sin(150 * x + 60 * y), across = std::cos(90 * y - 40 * x);
        out(v, u) = cv::Vec3b(cv::saturate_cast<uchar>(100 + 40 * wave),
                              cv::saturate_cast<uchar>(110 + 35 * across),
                              cv::saturate_cast<uchar>(120 + 25 * wave - 25 * across));
      }
    }
    return out;
  }

  double half_wide_, half_high_;
};

}  // namespace hypotrack::test
