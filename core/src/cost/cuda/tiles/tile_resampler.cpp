#include "cost/cuda/tiles/tile_resampler.hpp"

#include <fmt/format.h>

#include <array>

#include "cost/cuda/tiles/image_upload.hpp"
#include "cost/cuda/tiles/tile_kernels.hpp"
#include "cost/cuda/tiles/tile_upload.hpp"
#include "cost/cuda/tiles/view_resampling.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda::internal {
namespace {

std::size_t area(cv::Size size) {
  return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
}

/// Returns the bytes of a view's whole images.
std::size_t image_bytes(const View& view, cv::Size size) {
  const std::size_t bytes =
      (view.color.empty() ? 0 : 3) + (view.mask.empty() ? 0 : 1) + (view.depth.empty() ? 0 : 4);
  return bytes * area(size);
}

}  // namespace

struct TileResampler::Impl {
  /// The memory of one view on the device.
  struct Buffers {
    ImageUpload images;
    DeviceBuffer<std::uint32_t> means, tile_pixels;
    DeviceBuffer<float> tile_depth;
  };

  ViewResampling upload(std::size_t index, const View& view, const TileCamera& tile,
                        const ResamplePlan& plan, Stream stream);
  void make_room(Buffers& buffers, const View& view, const TileCamera& tile, cv::Size image);

  std::vector<Resampler> cameras;
  DeviceLimits limits;
  std::array<Buffers, kMaxViews> views;
  DeviceBuffer<FrameLayout> layout;
};

void TileResampler::Impl::make_room(Buffers& buffers, const View& view, const TileCamera& tile,
                                    cv::Size image) {
  buffers.images.begin(image_bytes(view, image));
  const std::size_t pixels = area({tile.width, tile.height});
  buffers.tile_pixels.reserve(pixels);
  if (!view.color.empty() || !view.mask.empty()) buffers.means.reserve(area(image));
  if (!view.depth.empty()) buffers.tile_depth.reserve(pixels);
}

ViewResampling TileResampler::Impl::upload(std::size_t index, const View& view,
                                           const TileCamera& tile, const ResamplePlan& plan,
                                           Stream stream) {
  const cv::Size image = cameras[index].image_size();
  Buffers& buffers = views[index];
  make_room(buffers, view, tile, image);
  ViewResampling out = view_resampling(cameras[index], tile, plan);
  if (!view.color.empty()) out.color = buffers.images.add(view.color, plan.touched, stream);
  if (!view.mask.empty()) out.mask = buffers.images.add(view.mask, plan.touched, stream);
  if (!view.depth.empty()) {
    const ImagePart& part = out.measured;
    out.depth = reinterpret_cast<const float*>(
        buffers.images.add(view.depth, {part.x, part.y, part.width, part.height}, stream));
    out.tile_depth = buffers.tile_depth.data();
  }
  if (out.color || out.mask) out.means = buffers.means.data();
  out.tile_pixels = buffers.tile_pixels.data();
  buffers.images.finish(stream);
  return out;
}

TileResampler::TileResampler(std::span<const Resampler> cameras, const DeviceLimits& limits)
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

TileResampler::~TileResampler() = default;

DeviceObservation TileResampler::resample(const Frame& frame, const TilePlan& plan, Stream stream,
                                          const BandEnds& bands) {
  DeviceObservation observation;
  observation.header = &plan.header;
  FrameResampling all{};
  all.layout = frame_layout(plan.header, bands);
  impl_->layout.reserve(1);
  all.layout_to = impl_->layout.data();
  observation.frame = all.layout_to;
  observation.pair = all.layout.pair != 0;
  all.view_count = static_cast<std::int32_t>(plan.views.size());
  for (std::size_t i = 0; i < plan.views.size(); ++i) {
    const View& view = frame.views[i];
    const TileCamera& tile = plan.header.views[i].camera;
    const ViewResampling out = all.views[i] = impl_->upload(i, view, tile, plan.views[i], stream);
    observation.tiles[i] = {{out.width, out.height, out.tile_pixels, out.tile_depth},
                            out.color != nullptr,
                            out.mask != nullptr};
  }
  enqueue_resampling(all, impl_->limits, stream);
  return observation;
}

}  // namespace hypotrack::cuda::internal
