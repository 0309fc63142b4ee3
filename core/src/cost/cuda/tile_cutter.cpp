#include "cost/cuda/tile_cutter.hpp"

#include <fmt/format.h>

#include <array>

#include "cost/cuda/frame_layout.hpp"
#include "cost/cuda/image_upload.hpp"
#include "cost/cuda/tile_kernels.hpp"
#include "cost/cuda/view_cut.hpp"
#include "hypotrack/cuda/runtime.cuh"
#include "hypotrack/error.hpp"

namespace hypotrack::cuda {
namespace {

std::size_t area(cv::Size size) {
  return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
}

/// Bytes of a view's whole images.
std::size_t image_bytes(const View& view, cv::Size size) {
  const std::size_t bytes =
      (view.color.empty() ? 0 : 3) + (view.mask.empty() ? 0 : 1) + (view.depth.empty() ? 0 : 4);
  return bytes * area(size);
}

}  // namespace

struct TileCutter::Impl {
  /// One view's memory on the device.
  struct Buffers {
    ImageUpload images;
    DeviceBuffer<std::uint32_t> means, tile_pixels;
    DeviceBuffer<float> tile_depth;
  };

  ViewCut upload(std::size_t index, const View& view, const TileCamera& tile, const CutPlan& plan,
                 Stream stream);
  void make_room(Buffers& buffers, const View& view, const TileCamera& tile, cv::Size image);

  std::vector<Resampler> cameras;
  DeviceLimits limits;
  std::array<Buffers, kMaxViews> views;
  DeviceBuffer<FrameLayout> layout;
};

void TileCutter::Impl::make_room(Buffers& buffers, const View& view, const TileCamera& tile,
                                 cv::Size image) {
  buffers.images.begin(image_bytes(view, image));
  const std::size_t pixels = area({tile.width, tile.height});
  buffers.tile_pixels.reserve(pixels);
  if (!view.color.empty() || !view.mask.empty()) buffers.means.reserve(area(image));
  if (!view.depth.empty()) buffers.tile_depth.reserve(pixels);
}

ViewCut TileCutter::Impl::upload(std::size_t index, const View& view, const TileCamera& tile,
                                 const CutPlan& plan, Stream stream) {
  const cv::Size image = cameras[index].image_size();
  Buffers& buffers = views[index];
  make_room(buffers, view, tile, image);
  ViewCut cut = view_cut(cameras[index], tile, plan);
  if (!view.color.empty()) cut.color = buffers.images.add(view.color, plan.touched, stream);
  if (!view.mask.empty()) cut.mask = buffers.images.add(view.mask, plan.touched, stream);
  if (!view.depth.empty()) {
    const ImagePart& part = cut.measured;
    cut.depth = reinterpret_cast<const float*>(
        buffers.images.add(view.depth, {part.x, part.y, part.width, part.height}, stream));
    cut.tile_depth = buffers.tile_depth.data();
  }
  if (cut.color || cut.mask) cut.means = buffers.means.data();
  cut.tile_pixels = buffers.tile_pixels.data();
  buffers.images.finish(stream);
  return cut;
}

TileCutter::TileCutter(std::span<const Resampler> cameras, const DeviceLimits& limits)
    : impl_(std::make_unique<Impl>()) {
  if (cameras.size() > kMaxViews) {
    throw DeviceError(
        fmt::format("evaluate.backend: cuda: the source has {} cameras, at most {} can be "
                    "evaluated on the GPU; write `backend: cpu`",
                    cameras.size(), kMaxViews));
  }
  impl_->cameras.assign(cameras.begin(), cameras.end());
  impl_->limits = limits;
}

TileCutter::~TileCutter() = default;

DeviceObservation TileCutter::cut(const Frame& frame, const TilePlan& plan, Stream stream,
                                  const WorkEnds& work) {
  DeviceObservation observation;
  observation.header = &plan.header;
  FrameCut cuts{};
  cuts.layout = frame_layout(plan.header, work);
  impl_->layout.reserve(1);
  cuts.layout_to = impl_->layout.data();
  observation.frame = cuts.layout_to;
  observation.pair = cuts.layout.pair != 0;
  cuts.view_count = static_cast<std::int32_t>(plan.cuts.size());
  for (std::size_t i = 0; i < plan.cuts.size(); ++i) {
    const View& view = frame.views[i];
    const TileCamera& tile = plan.header.views[i].camera;
    const ViewCut cut = cuts.views[i] = impl_->upload(i, view, tile, plan.cuts[i], stream);
    observation.tiles[i] = {{cut.width, cut.height, cut.tile_pixels, cut.tile_depth},
                            cut.color != nullptr,
                            cut.mask != nullptr};
  }
  enqueue_cut(cuts, impl_->limits, stream);
  return observation;
}

}  // namespace hypotrack::cuda
