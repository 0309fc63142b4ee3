#pragma once

#include <cmath>
#include <cstdint>

#include "camera/distort.hpp"
#include "hypotrack/pixel.hpp"

/// Where a pixel of a tile lies in the camera's image: plain data and the one function that the CPU
/// and CUDA share, without Eigen and OpenCV.
namespace hypotrack {

enum class Lens : std::int32_t { none, brown, fisheye };

/// A camera's lens, and how the ideal camera that tiles are cut from is turned against it.
struct LensMap {
  float camera_from_ideal[9];  ///< rotation, row by row
  float fx, fy, cx, cy;        ///< pixels
  float distortion[8];
  float largest_r2;  ///< what is farther off the axis (squared, on z = 1), the camera cannot see
  Lens lens;
};

/// The intrinsics of a tile's camera.
struct TileIntrinsics {
  float fx, fy, cx, cy;
};

struct ImagePoint {
  float x, y;
};

/// Both coordinates of what the camera cannot see: no image has them, and they fit the 16 bits of
/// cv::remap.
inline constexpr float kUnseen = -1e4f;

/// Image coordinates of what the ideal camera sees along (u, v, 1), in pixels.
HYPOTRACK_PIXEL ImagePoint image_point_along(const LensMap& map, float u, float v) {
  const float* r = map.camera_from_ideal;
  const float z = r[6] * u + (r[7] * v + r[8]);
  const float x = (r[0] * u + (r[1] * v + r[2])) / z;
  const float y = (r[3] * u + (r[4] * v + r[5])) / z;
  const float r2 = x * x + y * y;
  float xd = x;
  float yd = y;
  if (map.lens == Lens::brown) {
    distort_brown(map.distortion, x, y, xd, yd);
  } else if (map.lens == Lens::fisheye) {
    const float factor = fisheye_factor(map.distortion, std::sqrt(r2));
    xd = x * factor;
    yd = y * factor;
  }
  const bool seen = z > 0.0f && r2 < map.largest_r2;
  return {seen ? xd * map.fx + map.cx : kUnseen, seen ? yd * map.fy + map.cy : kUnseen};
}

/// Image coordinates of a position in the tile, in pixels.
HYPOTRACK_PIXEL ImagePoint image_point(const LensMap& map, const TileIntrinsics& tile, float column,
                                       float row) {
  return image_point_along(map, (column - tile.cx) / tile.fx, (row - tile.cy) / tile.fy);
}

/// What a depth measured along the camera's axis is along the tile's, for a pixel of the tile.
HYPOTRACK_PIXEL float depth_along_tile(const LensMap& map, const TileIntrinsics& tile, int column,
                                       int row, float depth) {
  const float* axis = map.camera_from_ideal + 6;
  const float u = (static_cast<float>(column) - tile.cx) / tile.fx;
  const float v = (static_cast<float>(row) - tile.cy) / tile.fy;
  return depth / (axis[0] * u + (axis[1] * v + axis[2]));
}

/// The image pixel that a point on the image lies in; halves go up, as inside_image() has it.
HYPOTRACK_PIXEL int nearest_pixel(float coordinate, int size) {
  const int nearest = static_cast<int>(std::floor(coordinate + 0.5f));
  return nearest < size ? nearest : size - 1;
}

/// Whether a point lies on the image: a pixel reaches half a pixel around its centre.
HYPOTRACK_PIXEL bool inside_image(ImagePoint p, int width, int height) {
  return p.x >= -0.5f && p.x < static_cast<float>(width) - 0.5f && p.y >= -0.5f &&
         p.y < static_cast<float>(height) - 0.5f;
}

}  // namespace hypotrack
