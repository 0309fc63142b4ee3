#include "tile/resample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "tile/grid_lookup.hpp"

namespace hypotrack::internal {
namespace {

/// Returns whether a camera's pictures are those of its ideal camera.
bool is_plain(const LensMap& lens) {
  for (int i = 0; i < 9; ++i)
    if (lens.camera_from_ideal[i] != (i % 4 == 0 ? 1.0f : 0.0f)) return false;
  return lens.lens == Lens::none;
}

cv::Mat inside_mask(const ImageMap& map, int size, cv::Size image) {
  cv::Mat valid(size, size, CV_8U);
  if (map.is_grid) {
    const auto flags = [&](const cv::Mat& positions, int end) -> cv::Mat {
      cv::Mat inside;
      cv::inRange(positions, -0.5, std::nextafter(static_cast<float>(end) - 0.5f, 0.0f), inside);
      return inside;
    };
    const cv::Rect inner(1, 1, size, size);
    const cv::Mat column = flags(map.x(inner).row(0), image.width);
    const cv::Mat row = flags(map.y(inner).col(0), image.height);
    valid.setTo(0);
    for (int v = 0; v < size; ++v)
      if (row.at<unsigned char>(v) != 0) column.copyTo(valid.row(v));
    return valid;
  }
  for (int v = 0; v < size; ++v) {
    const float* x = map.x.ptr<float>(v + 1) + 1;
    const float* y = map.y.ptr<float>(v + 1) + 1;
    auto* out = valid.ptr<unsigned char>(v);
    for (int u = 0; u < size; ++u) {
      out[u] = inside_image({x[u], y[u]}, image.width, image.height) ? 255 : 0;
    }
  }
  return valid;
}

/// Returns the depth of each tile pixel's nearest image pixel, converted from the camera's optical
/// axis to the tile's. Never interpolates. Values that are not positive numbers count as
/// unmeasured.
cv::Mat nearest_depth(const cv::Mat& depth, const cv::Mat& valid, const ImageMap& map,
                      const TileCamera& tile, const LensMap& lens) {
  const TileIntrinsics camera = intrinsics(tile);
  cv::Mat out = cv::Mat::zeros(valid.size(), CV_32F);
  for (int v = 0; v < valid.rows; ++v) {
    const float* x = map.x.ptr<float>(v + 1) + 1;
    const float* y = map.y.ptr<float>(v + 1) + 1;
    const auto* inside = valid.ptr<unsigned char>(v);
    auto* to = out.ptr<float>(v);
    for (int u = 0; u < valid.cols; ++u) {
      if (inside[u] == 0) continue;
      const float z =
          depth.at<float>(nearest_pixel(y[u], depth.rows), nearest_pixel(x[u], depth.cols));
      const float along = depth_along_tile(lens, camera, u, v, z);
      if (along > 0 && std::isfinite(along)) to[u] = along;
    }
  }
  return out;
}

/// Positions of a tile's samples in the block means of the part that its plan touches. Those of a
/// grid have one row of x and one column of y.
struct Lookups {
  cv::Mat x, y;
  bool is_grid;
};

Lookups lookups(const ImageMap& map, int size, const ResamplePlan& plan) {
  // Pixel centres are at integers, so a block's centre is half a block minus half a pixel in.
  const double factor = 1.0 / plan.reduction.blocks;
  const int samples = plan.reduction.samples;
  constexpr int kFew = 3;  // equal rows or columns: a margin on either side of one
  const cv::Mat columns = map.is_grid ? map.x.rowRange(0, kFew) : map.x;
  const cv::Mat rows = map.is_grid ? map.y.colRange(0, kFew) : map.y;
  cv::Mat x, y;
  columns.convertTo(x, CV_32F, factor, (0.5 - plan.touched.x) * factor - 0.5);
  rows.convertTo(y, CV_32F, factor, (0.5 - plan.touched.y) * factor - 0.5);
  if (samples > 1) {
    // Linear interpolation of the map is accurate to about 0.001 pixels, because lenses are smooth.
    for (cv::Mat* each : {&x, &y})
      cv::resize(*each, *each, each->size() * samples, 0, 0, cv::INTER_LINEAR);
  }
  const cv::Range inner(samples, samples + size * samples), one(samples, samples + 1);
  return {x(map.is_grid ? one : inner, inner), y(inner, map.is_grid ? one : inner), map.is_grid};
}

/// Applies a colour map to a tile (8-bit BGR).
cv::Mat with_colors(const cv::Mat& color, const ColorMap& map) {
  if (keeps_colors(map)) return color;
  cv::Mat table(1, 256, CV_8UC3);
  for (int value = 0; value < 256; ++value) {
    for (int i = 0; i < 3; ++i) {
      table.at<cv::Vec3b>(value)[i] =
          static_cast<unsigned char>(mapped_channel(map, i, static_cast<std::uint32_t>(value)));
    }
  }
  cv::Mat out;
  cv::LUT(color, table, out);
  return out;
}

std::vector<float> numbers_of(const cv::Mat1f& positions) {
  return {positions.begin(), positions.end()};
}

/// Samples the part of an image that a plan touches at lookups().
cv::Mat look_up(cv::Mat part, const Lookups& at, int size, const ReductionPlan& reduction) {
  const auto [blocks, samples] = reduction;
  cv::Mat out;
  if (blocks > 1) {
    cv::Mat means;
    cv::resize(part, means, part.size() / blocks, 0, 0, cv::INTER_AREA);
    part = means;
  }
  if (at.is_grid && part.type() == CV_8UC3)
    return look_up_grid(part, axis_places(numbers_of(at.x), part.cols),
                        axis_places(numbers_of(at.y), part.rows), samples);
  const cv::Mat x = at.is_grid ? cv::repeat(at.x, at.y.rows, 1) : at.x;
  const cv::Mat y = at.is_grid ? cv::repeat(at.y, 1, at.x.cols) : at.y;
  cv::remap(part, out, x, y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  if (samples > 1) cv::resize(out, out, cv::Size(size, size), 0, 0, cv::INTER_AREA);
  return out;
}

}  // namespace

cv::Mat brightened(const cv::Mat& color, const cv::Mat& by) {
  if (by.empty()) return color;
  cv::Mat all, out;
  cv::merge(std::array{by, by, by}, all);
  cv::add(color, all, out, cv::noArray(), CV_8UC3);
  return out;
}

Resampler::Resampler(const Camera& camera, const Eigen::Matrix3d& camera_from_ideal)
    : lens_(make_lens_map(camera, camera_from_ideal)), image_(camera.width, camera.height) {}

ImageMap Resampler::map(const TileCamera& tile) const {
  const int columns = tile.width + 2;
  const int rows = tile.height + 2;
  ImageMap map{cv::Mat(rows, columns, CV_32F), cv::Mat(rows, columns, CV_32F), is_plain(lens_)};
  const TileIntrinsics camera = intrinsics(tile);
  for (int row = 0; row < rows; ++row) {
    auto* x = map.x.ptr<float>(row);
    auto* y = map.y.ptr<float>(row);
    const auto v = static_cast<float>(row - 1);
    if (map.is_grid && row > 0) {
      std::copy_n(map.x.ptr<float>(0), columns, x);
      std::fill_n(y, columns, image_point(lens_, camera, -1, v).y);
      continue;
    }
    for (int column = 0; column < columns; ++column) {
      const ImagePoint p = image_point(lens_, camera, static_cast<float>(column - 1), v);
      x[column] = p.x;
      y[column] = p.y;
    }
  }
  return map;
}

TileView Resampler::resample(const View& view, const TileCamera& tile,
                             const ResamplePlan& plan) const {
  const int size = tile.width;
  const ImageMap map = this->map(tile);
  TileView out;
  out.camera = tile;
  out.valid = inside_mask(map, size, image_);
  if (!plan.hidden.empty()) out.valid.setTo(0, plan.hidden);
  if (!view.depth.empty()) out.depth = nearest_depth(view.depth, out.valid, map, tile, lens_);
  if (view.color.empty() && view.mask.empty()) return out;
  const auto at = lookups(map, size, plan);
  if (!view.color.empty()) {
    const cv::Mat color =
        with_colors(look_up(view.color(plan.touched), at, size, plan.reduction), plan.colors);
    out.color = brightened(color, plan.brightness);
  }
  if (!view.mask.empty()) {
    out.mask = look_up(view.mask(plan.touched) != 0, at, size, plan.reduction) >= 128;
    out.mask &= out.valid;
  }
  return out;
}

cv::Mat Resampler::resample_background(const cv::Mat& touched, const TileCamera& tile,
                                       const ResamplePlan& plan) const {
  const ImageMap map = this->map(tile);
  const cv::Mat samples =
      look_up(touched, lookups(map, tile.width, plan), tile.width, plan.reduction);
  cv::Mat color, known, out;
  cv::cvtColor(samples, color, cv::COLOR_BGRA2BGR);
  cv::extractChannel(samples, known, 3);
  known = known == 255;
  known &= inside_mask(map, tile.width, image_);
  cv::merge(std::array{with_colors(color, plan.colors), known}, out);
  return out;
}

}  // namespace hypotrack::internal
