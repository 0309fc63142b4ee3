#pragma once

#include "cost/cuda/tile_pixels.hpp"
#include "tile/resample.hpp"

namespace hypotrack::cuda {

/// Depth is not reduced, so that the image's last pixels that fill no block count as well.
inline ImagePart measured_part(const CutPlan& plan, cv::Size image) {
  const int blocks = plan.reduction.blocks;
  const cv::Point end = plan.touched.br();
  ImagePart part{plan.touched.x, plan.touched.y, plan.touched.width, plan.touched.height};
  if (image.width - end.x < blocks) part.width = image.width - part.x;
  if (image.height - end.y < blocks) part.height = image.height - part.y;
  return part;
}

/// The cut of a tile out of a camera's view, without the pointers.
inline ViewCut view_cut(const Resampler& camera, const TileCamera& tile, const CutPlan& plan) {
  const cv::Size image = camera.image_size();
  ViewCut cut{};
  cut.lens = camera.lens();
  cut.camera = intrinsics(tile);
  cut.width = tile.width;
  cut.height = tile.height;
  cut.image_width = image.width;
  cut.image_height = image.height;
  cut.blocks = plan.reduction.blocks;
  cut.samples = plan.reduction.samples;
  // Pixel centres are at integers, so a block's centre is half a block less half a pixel in.
  const double scale = 1.0 / cut.blocks;
  cut.means_scale = static_cast<float>(scale);
  cut.means_x = static_cast<float>((0.5 - plan.touched.x) * scale - 0.5);
  cut.means_y = static_cast<float>((0.5 - plan.touched.y) * scale - 0.5);
  cut.colors = plan.colors;
  cut.touched = {plan.touched.x, plan.touched.y, plan.touched.width, plan.touched.height};
  cut.measured = measured_part(plan, image);
  return cut;
}

}  // namespace hypotrack::cuda
