#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "hypotrack/gpu/layout.hpp"
#include "test_cameras.hpp"
#include "tile/resample.hpp"

namespace hypotrack::test {

/// One tile to be cut, in every way that there is.
struct TileCase {
  std::string name;
  Camera camera;
  Eigen::Matrix3d camera_from_ideal;
  TileCamera tile;
  View view;
};

/// A view of noise: every pixel tells itself from its neighbours.
inline View noise_view(const Camera& camera, bool color, bool mask, bool depth) {
  cv::RNG random(7);
  View view;
  if (color) {
    view.color.create(camera.height, camera.width, CV_8UC3);
    random.fill(view.color, cv::RNG::UNIFORM, 0, 256);
  }
  if (mask) {
    view.mask.create(camera.height, camera.width, CV_8U);
    random.fill(view.mask, cv::RNG::UNIFORM, 0, 3);
  }
  if (depth) {
    view.depth.create(camera.height, camera.width, CV_32F);
    random.fill(view.depth, cv::RNG::UNIFORM, 0.3, 0.9);
    view.depth.col(camera.width / 2) = 0;
    view.depth.col(camera.width / 2 + 3) = std::numeric_limits<float>::quiet_NaN();
    view.depth.col(camera.width / 2 + 6) = std::numeric_limits<float>::infinity();
  }
  return view;
}

/// A tile around a direction of the camera, about `scale` image pixels per pixel.
inline TileCamera tile_towards(const Eigen::Matrix3d& camera_from_ideal,
                               const Eigen::Vector3d& direction, double scale, int size = 96) {
  const Eigen::Vector3d ray = camera_from_ideal.transpose() * direction;
  TileCamera tile;
  tile.width = tile.height = size;
  tile.fx = tile.fy = 700.3 / scale;
  tile.cx = 0.5 * (size - 1) - tile.fx * ray.x() / ray.z() + 0.137;
  tile.cy = 0.5 * (size - 1) - tile.fy * ray.y() / ray.z() - 0.291;
  return tile;
}

/// Lens x rectified or not x scale x what the view has, and the odd ones.
inline std::vector<TileCase> tile_cases() {
  std::vector<TileCase> cases;
  const auto add = [&](const std::string& name, const Camera& camera, bool turned, double x,
                       double scale, int has, int size = 96) {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    if (turned) turn = pose({0.05, 0.1, -0.03}, {0, 0, 0}).linear();
    cases.push_back({name, camera, turn, tile_towards(turn, {x, 0.05, 1}, scale, size),
                     noise_view(camera, has & 1, has & 2, has & 4)});
  };
  for (const int lens : {0, 5, 8, 14, -4}) {
    for (const bool turned : {false, true}) {
      for (const double scale : {0.5, 1.0, 2.5, 3.05, 4.0}) {
        const std::string name = "lens " + std::to_string(lens) + (turned ? ", turned" : "") +
                                 ", scale " + std::to_string(scale);
        add(name, lens_camera(lens), turned, 0.1, scale, 7);
      }
    }
    const std::string name = "lens " + std::to_string(lens);
    add(name + ", colour only", lens_camera(lens), true, 0.1, 1.4, 1);
    add(name + ", depth only", lens_camera(lens), true, 0.1, 2.2, 4);
    add(name + ", depth and mask", lens_camera(lens), true, 0.1, 2.2, 6);
    add(name + ", right border", lens_camera(lens), true, 0.85, 2.6, 7);
    add(name + ", beyond the border", lens_camera(lens), false, 2.5, 1.0, 7);
  }
  Camera small = lens_camera(4);
  small.width = 50;
  small.height = 37;
  small.cx = 24.7;
  small.cy = 18.2;
  add("image within the tile", small, false, 0, 1.0, 7);
  add("image far within the tile", small, true, 0, 3.4, 7, 65);
  Camera folding = lens_camera(5);
  folding.distortion = {0.0, 0.0, 0.0, 0.0, -1.0};
  add("lens that folds", folding, false, 0.7, 1.0, 7);
  return cases;
}

/// Compares pixels in the layout of the device with the CPU's tile. All but a thousandth of the
/// bytes are equal; where a lookup lies between two steps of 1/32 pixel, noise makes it differ by
/// 255/32, and a mask's rounded share falls to either side.
inline void expect_same_tile(const TileView& expected, const std::vector<std::uint32_t>& pixels,
                             const std::vector<float>& depth) {
  int bytes = 0, different = 0, flags = 0;
  const int size = expected.camera.width;
  ASSERT_EQ(pixels.size(), static_cast<std::size_t>(size * size));
  for (int i = 0; i < size * size; ++i) {
    const int y = i / size, x = i % size;
    const std::uint32_t word = pixels[static_cast<std::size_t>(i)];
    const bool valid = expected.valid.at<unsigned char>(y, x) != 0;
    const bool inside = !expected.mask.empty() && expected.mask.at<unsigned char>(y, x) != 0;
    flags += valid != ((word & cuda::kValidFlag) != 0);
    flags += inside != ((word & cuda::kForegroundFlag) != 0);
    for (int c = 0; c < 3; ++c, ++bytes) {
      const int e = expected.color.empty() ? 0 : expected.color.at<cv::Vec3b>(y, x)[c];
      const int found = static_cast<int>((word >> (8 * c)) & 255);
      different += e != found;
      ASSERT_LE(std::abs(e - found), 8) << x << ", " << y << ", channel " << c;
    }
    EXPECT_EQ(word >> 26, 0u);
  }
  EXPECT_LE(different, bytes / 1000);
  EXPECT_LE(flags, 1 + size * size / 1000);
  ASSERT_EQ(depth.empty(), expected.depth.empty());
  int depths = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const auto at = static_cast<int>(i);
    const float e = expected.depth.at<float>(at / size, at % size);
    // Another pixel where the lookup lies between two.
    depths += !(std::abs(e - depth[i]) <= 2e-7f * e);
  }
  EXPECT_LE(depths, size * size / 1000);
}

}  // namespace hypotrack::test
