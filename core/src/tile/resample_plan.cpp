#include "tile/resample_plan.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "camera/lens/distortion.hpp"

namespace hypotrack::internal {
namespace {

constexpr int kGrid = 9;  // sample positions along one side of a tile

Lens lens_of(const Camera& camera) {
  switch (camera.distortion_model) {
    case DistortionModel::none:
      return Lens::none;
    case DistortionModel::brown:
      return has_prisms_or_tilt(camera) ? Lens::full : Lens::brown;
    case DistortionModel::fisheye:
      return Lens::fisheye;
  }
  return Lens::none;
}

/// One image coordinate at a grid of positions over a tile and its margin of one pixel, which the
/// map's interpolation reads.
using Grid = Eigen::Array<float, kGrid, kGrid>;

/// Samples the map; returns false if the camera cannot see some position.
bool sample(const LensMap& map, const TileCamera& tile, Grid& x, Grid& y) {
  const TileIntrinsics camera = intrinsics(tile);
  const float step_u = static_cast<float>(tile.width + 1) / (kGrid - 1);
  const float step_v = static_cast<float>(tile.height + 1) / (kGrid - 1);
  std::array<float, kGrid> u;
  std::array<float, kGrid> v;
  for (int i = 0; i < kGrid; ++i) {
    u[i] = (static_cast<float>(i) * step_u - 1.0f - camera.cx) / camera.fx;
    v[i] = (static_cast<float>(i) * step_v - 1.0f - camera.cy) / camera.fy;
  }
  bool seen = true;
  for (int i = 0; i < kGrid; ++i) {
    for (int j = 0; j < kGrid; ++j) {
      const ImagePoint p = image_point_along(map, u[i], v[j]);
      x(j, i) = p.x;
      y(j, i) = p.y;
      seen = seen && p.x != kUnseen;
    }
  }
  return seen;
}

/// Returns the sum of the largest second differences along rows and columns. Between samples, the
/// map deviates from linear by an eighth of them.
float bend(const Grid& grid) {
  constexpr int kInner = kGrid - 2;
  const auto along_rows =
      grid.leftCols<kInner>() - 2 * grid.middleCols<kInner>(1) + grid.rightCols<kInner>();
  const auto along_columns =
      grid.topRows<kInner>() - 2 * grid.middleRows<kInner>(1) + grid.bottomRows<kInner>();
  return along_rows.abs().maxCoeff() + along_columns.abs().maxCoeff();
}

/// Returns the pixels 0 .. end around the positions in whole blocks. Positions outside the image
/// are clamped to its border.
cv::Range block_range(const Grid& grid, double margin, int end, int blocks) {
  const auto within = [end](float a) { return std::clamp(double{a}, 0.0, end - 1.0); };
  const double low = within(grid.minCoeff());
  const double high = within(grid.maxCoeff());
  const int last = end / blocks;
  const auto block = [blocks, last](double a) {
    return static_cast<int>(std::clamp(a / blocks, 0.0, static_cast<double>(last)));
  };
  const int first_block = std::min(block(low - margin), last - 1);
  const int end_block = std::clamp(block(high + margin) + 1, first_block + 1, last);
  return {first_block * blocks, end_block * blocks};
}

cv::Rect touched(const LensMap& map, const TileCamera& tile, cv::Size image, double scale,
                 int blocks) {
  Grid x;
  Grid y;
  if (!sample(map, tile, x, y))  // the visible part ends between two positions
    return {0, 0, image.width / blocks * blocks, image.height / blocks * blocks};
  constexpr double kSafety = 0.5;  // four times one eighth
  const double margin = 2 * blocks + scale;
  const cv::Range columns = block_range(x, margin + kSafety * bend(x), image.width, blocks);
  const cv::Range rows = block_range(y, margin + kSafety * bend(y), image.height, blocks);
  return {columns.start, rows.start, columns.size(), rows.size()};
}

}  // namespace

LensMap make_lens_map(const Camera& camera, const Eigen::Matrix3d& camera_from_ideal) {
  LensMap map{};
  for (int i = 0; i < 9; ++i) {
    map.camera_from_ideal[i] = static_cast<float>(camera_from_ideal(i / 3, i % 3));
  }
  map.fx = static_cast<float>(camera.fx);
  map.fy = static_cast<float>(camera.fy);
  map.cx = static_cast<float>(camera.cx);
  map.cy = static_cast<float>(camera.cy);
  const DistortionCoefficients k = distortion_coefficients(camera);
  std::transform(k.begin(), k.end(), map.distortion,
                 [](double v) { return static_cast<float>(v); });
  const double r = std::min(monotonic_radius(camera), 1e6);
  map.largest_r2 = static_cast<float>(r * r);
  map.lens = lens_of(camera);
  return map;
}

TileIntrinsics intrinsics(const TileCamera& tile) {
  return {static_cast<float>(tile.fx), static_cast<float>(tile.fy), static_cast<float>(tile.cx),
          static_cast<float>(tile.cy)};
}

double scale_at_centre(const LensMap& map, const TileCamera& tile) {
  const TileIntrinsics camera = intrinsics(tile);
  const auto u = static_cast<float>((tile.height + 2) / 2 - 1);
  const ImagePoint p = image_point(map, camera, u, u);
  const ImagePoint right = image_point(map, camera, u + 1, u);
  const ImagePoint below = image_point(map, camera, u, u + 1);
  const double dxu = right.x - p.x;
  const double dyu = right.y - p.y;
  const double dxv = below.x - p.x;
  const double dyv = below.y - p.y;
  const double area = std::abs(dxu * dyv - dyu * dxv);
  const bool seen = p.x != kUnseen && right.x != kUnseen && below.x != kUnseen;
  return seen && area > 0 ? std::sqrt(area) : std::sqrt(double{map.fx} * map.fy) / tile.fx;
}

ReductionPlan plan_reduction(double scale) {
  constexpr double kSharp = 1.15;
  ReductionPlan plan;
  plan.blocks = static_cast<int>(std::clamp(scale, 1.0, 1e6));
  plan.samples = scale / plan.blocks > kSharp ? 2 : 1;
  return plan;
}

ResamplePlan plan_resampling(const LensMap& map, const TileCamera& tile, cv::Size image,
                             double scale) {
  ResamplePlan plan;
  plan.reduction = plan_reduction(scale);
  plan.reduction.blocks = std::min({plan.reduction.blocks, image.width, image.height});
  plan.touched = touched(map, tile, image, scale, plan.reduction.blocks);
  return plan;
}

}  // namespace hypotrack::internal
