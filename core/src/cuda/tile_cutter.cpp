#include "cuda/tile_cutter.hpp"

#include <fmt/format.h>

#include <array>

#include "cuda/image_upload.hpp"
#include "cuda/tile_kernels.hpp"
#include "cuda/view_cut.hpp"
#include "hypotrack/cuda/runtime.cuh"
#include "hypotrack/error.hpp"

namespace hypotrack::cuda {
namespace {

std::size_t area(cv::Size size) {
  return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
}

/// Bytes of a view's whole images, whose rows may each begin at a multiple of 4.
std::size_t image_bytes(const View& view, cv::Size size) {
  std::size_t bytes = 0;
  for (const cv::Mat* image : {&view.color, &view.mask, &view.depth}) {
    if (image->empty()) continue;
    const auto width = static_cast<std::size_t>(size.width);
    bytes += (image->elemSize() * width + 3) * static_cast<std::size_t>(size.height);
  }
  return bytes;
}

}  // namespace

struct TileCutter::Impl {
  /// One view's memory on the device.
  struct Buffers {
    DeviceBuffer<std::uint32_t> means, tile_pixels;
    DeviceBuffer<float> tile_depth;
  };

  void make_room(const Frame& frame, const TilePlan& plan);
  ViewCut upload(std::size_t index, const View& view, const TileCamera& tile, const CutPlan& plan);

  std::vector<Resampler> cameras;
  DeviceLimits limits;
  ImageUpload images;
  std::array<Buffers, kMaxViews> views;
};

void TileCutter::Impl::make_room(const Frame& frame, const TilePlan& plan) {
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < plan.cuts.size(); ++i) {
    const View& view = frame.views[i];
    const TileCamera& tile = plan.header.views[i].camera;
    const cv::Size image = cameras[i].image_size();
    const std::size_t pixels = area({tile.width, tile.height});
    views[i].tile_pixels.reserve(pixels);
    if (!view.color.empty() || !view.mask.empty()) views[i].means.reserve(area(image));
    if (!view.depth.empty()) views[i].tile_depth.reserve(pixels);
    bytes += image_bytes(view, image);
  }
  images.begin(bytes);
}

template <class Pixel>
Rows<Pixel> added(ImageUpload& images, const cv::Mat& image, const cv::Rect& part) {
  if (image.empty()) return {};
  const ImageUpload::Placed placed = images.add(image, part);
  return {placed.first, placed.pitch};
}

ViewCut TileCutter::Impl::upload(std::size_t index, const View& view, const TileCamera& tile,
                                 const CutPlan& plan) {
  Buffers& buffers = views[index];
  ViewCut cut = view_cut(cameras[index], tile, plan);
  const ImagePart& measured = cut.measured;
  cut.color = added<unsigned char>(images, view.color, plan.touched);
  cut.mask = added<unsigned char>(images, view.mask, plan.touched);
  cut.depth =
      added<float>(images, view.depth, {measured.x, measured.y, measured.width, measured.height});
  if (cut.color.first || cut.mask.first) cut.means = buffers.means.data();
  if (cut.depth.first) cut.tile_depth = buffers.tile_depth.data();
  cut.tile_pixels = buffers.tile_pixels.data();
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

DeviceObservation TileCutter::cut(const Frame& frame, const TilePlan& plan, Stream stream) {
  DeviceObservation observation;
  observation.header = &plan.header;
  FrameCut cuts{};
  cuts.view_count = static_cast<std::int32_t>(plan.cuts.size());
  impl_->make_room(frame, plan);
  for (std::size_t i = 0; i < plan.cuts.size(); ++i) {
    const View& view = frame.views[i];
    const TileCamera& tile = plan.header.views[i].camera;
    const ViewCut cut = cuts.views[i] = impl_->upload(i, view, tile, plan.cuts[i]);
    observation.tiles[i] = {{cut.width, cut.height, cut.tile_pixels, cut.tile_depth},
                            cut.color.first != nullptr,
                            cut.mask.first != nullptr};
  }
  impl_->images.enqueue(stream);
  enqueue_cut(cuts, impl_->limits, stream);
  return observation;
}

}  // namespace hypotrack::cuda
