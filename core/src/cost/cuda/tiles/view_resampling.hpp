#pragma once

#include "base/exported.hpp"
#include "cost/cuda/tiles/tile_pixels.hpp"
#include "tile/resample.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the part of an image that depth is read from. Depth is not reduced, so it includes the
/// last pixels that fill no block.
inline ImagePart measured_part(const ResamplePlan& plan, cv::Size image) {
  const int blocks = plan.reduction.blocks;
  const cv::Point end = plan.touched.br();
  ImagePart part{plan.touched.x, plan.touched.y, plan.touched.width, plan.touched.height};
  if (image.width - end.x < blocks) part.width = image.width - part.x;
  if (image.height - end.y < blocks) part.height = image.height - part.y;
  return part;
}

/// Returns the parameters of a tile's resampling; all pointers are null.
inline ViewResampling view_resampling(const Resampler& camera, const TileCamera& tile,
                                      const ResamplePlan& plan) {
  const cv::Size image = camera.image_size();
  ViewResampling out{};
  out.lens = camera.lens();
  out.camera = intrinsics(tile);
  out.width = tile.width;
  out.height = tile.height;
  out.image_width = image.width;
  out.image_height = image.height;
  out.blocks = plan.reduction.blocks;
  out.samples = plan.reduction.samples;
  // Pixel centres are at integers, so a block's centre is half a block less half a pixel in.
  const double scale = 1.0 / out.blocks;
  out.means_scale = static_cast<float>(scale);
  out.means_x = static_cast<float>((0.5 - plan.touched.x) * scale - 0.5);
  out.means_y = static_cast<float>((0.5 - plan.touched.y) * scale - 0.5);
  out.colors = plan.colors;
  out.touched = {plan.touched.x, plan.touched.y, plan.touched.width, plan.touched.height};
  out.measured = measured_part(plan, image);
  return out;
}

}  // namespace internal
}  // namespace hypotrack::cuda
