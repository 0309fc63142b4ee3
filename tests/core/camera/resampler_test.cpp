#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>

#include "camera/rectification.hpp"
#include "test_cameras.hpp"
#include "tile/resample.hpp"

namespace hypotrack {
namespace {

TEST(Resampler, MapsAsOpenCvsUndistortionDoes) {
  const Eigen::Matrix3d turn = test::pose({0.05, 0.1, -0.03}, {0, 0, 0}).linear();
  cv::Matx33d r;  // OpenCV's R takes the camera's axes to the ideal ones
  for (int i = 0; i < 9; ++i) r.val[i] = turn.transpose()(i / 3, i % 3);
  TileCamera tile;
  tile.width = tile.height = 100;
  tile.fx = tile.fy = 180;
  tile.cx = 90;
  tile.cy = 20;
  for (const int lens : {0, 4, 5, 8, 12, 14, -4}) {
    const Camera camera = test::lens_camera(lens);
    const cv::Matx33d k(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    const cv::Matx33d k_tile(tile.fx, 0, tile.cx, 0, tile.fy, tile.cy, 0, 0, 1);
    cv::Mat x, y;
    if (lens < 0) {
      cv::fisheye::initUndistortRectifyMap(k, camera.distortion, r, k_tile, {100, 100}, CV_32F, x,
                                           y);
    } else {
      cv::initUndistortRectifyMap(k, camera.distortion, r, k_tile, {100, 100}, CV_32F, x, y);
    }
    const Resampler resampler(camera, turn);
    const ImageMap map = resampler.map(tile);
    const cv::Rect inner(1, 1, 100, 100);
    EXPECT_LT(cv::norm(map.x(inner), x, cv::NORM_INF), 2e-3) << lens;
    EXPECT_LT(cv::norm(map.y(inner), y, cv::NORM_INF), 2e-3) << lens;
    EXPECT_NEAR(scale_at_centre(resampler.lens(), tile), 700.0 / 180, 0.4) << lens;
  }
}

}  // namespace
}  // namespace hypotrack
