#pragma once

#include <cmath>
#include <cstdint>

#include "base/exported.hpp"
#include "camera/lens/distort.hpp"
#include "hypotrack/plugin/pixel.hpp"

/// Maps tile pixels to a camera's image: plain data and the one function that CPU and CUDA share,
/// without Eigen and OpenCV.
namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

enum class Lens : std::int32_t { none, brown, fisheye, full };

/// A camera's lens and its rotation against the ideal camera of its tiles.
struct LensMap {
  float camera_from_ideal[9];  ///< rotation, row by row
  float fx, fy, cx, cy;        ///< pixels
  float distortion[19];        ///< as DistortionCoefficients
  float largest_r2;            ///< squared largest visible distance from the axis, on z = 1
  Lens lens;
};

/// The intrinsics of a tile's camera, pixels.
struct TileIntrinsics {
  float fx, fy, cx, cy;
};

struct ImagePoint {
  float x, y;
};

/// Both coordinates of a point that the camera cannot see. It lies outside every image and fits
/// cv::remap's 16 bits.
inline constexpr float kUnseen = -1e4f;

/// Returns the image position, in pixels, of the ideal camera's ray (u, v, 1).
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
  } else if (map.lens == Lens::full) {
    distort_full(map.distortion, x, y, xd, yd);
  } else if (map.lens == Lens::fisheye) {
    const float factor = fisheye_factor(map.distortion, std::sqrt(r2));
    xd = x * factor;
    yd = y * factor;
  }
  const bool seen = z > 0.0f && r2 < map.largest_r2;
  return {seen ? xd * map.fx + map.cx : kUnseen, seen ? yd * map.fy + map.cy : kUnseen};
}

/// Returns the image position, in pixels, of a position in the tile.
HYPOTRACK_PIXEL ImagePoint image_point(const LensMap& map, const TileIntrinsics& tile, float column,
                                       float row) {
  return image_point_along(map, (column - tile.cx) / tile.fx, (row - tile.cy) / tile.fy);
}

/// Converts a depth along the camera's axis to one along the tile's, for a pixel of the tile.
HYPOTRACK_PIXEL float depth_along_tile(const LensMap& map, const TileIntrinsics& tile, int column,
                                       int row, float depth) {
  const float* axis = map.camera_from_ideal + 6;
  const float u = (static_cast<float>(column) - tile.cx) / tile.fx;
  const float v = (static_cast<float>(row) - tile.cy) / tile.fy;
  return depth / (axis[0] * u + (axis[1] * v + axis[2]));
}

/// Returns the image pixel that contains a coordinate; halves round up, as in inside_image().
HYPOTRACK_PIXEL int nearest_pixel(float coordinate, int size) {
  const int nearest = static_cast<int>(std::floor(coordinate + 0.5f));
  return nearest < size ? nearest : size - 1;
}

/// Returns true if a point lies on the image; a pixel extends half a pixel around its centre.
HYPOTRACK_PIXEL bool inside_image(ImagePoint p, int width, int height) {
  return p.x >= -0.5f && p.x < static_cast<float>(width) - 0.5f && p.y >= -0.5f &&
         p.y < static_cast<float>(height) - 0.5f;
}

}  // namespace internal
}  // namespace hypotrack
