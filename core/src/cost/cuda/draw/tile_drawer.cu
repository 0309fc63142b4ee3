#include "cost/cuda/draw/tile_drawer.hpp"

#include <algorithm>
#include <utility>

#include "hypotrack/gpu/evaluate.cuh"

namespace hypotrack::cuda::internal {
namespace {

constexpr std::int64_t kMostBytes = std::int64_t{32} << 20;  // of tiles; less than the L2 cache

/// A Term that stores the depth of every pixel of a pair, or of single views.
template <bool kPair>
struct DepthTerm {
  static constexpr bool kStereo = kPair;
  static constexpr bool kVisitsUncovered = true;
  static constexpr int kSums = 1;

  float* depth;
  std::int64_t stride;  // from one hypothesis to the next
  int bands;            // blocks per hypothesis
  int view_bits;
  int before[kMaxViews], width[kMaxViews];
  float tolerance;

  __device__ int directions() const { return 3; }
  __device__ int views() const { return view_bits; }
  template <int kReference>
  __device__ void pixel(const StereoPixel& p, float (&)[kSums]) const {
    put(kReference, p.x, p.y, p.inverse_depth);
  }
  __device__ void pixel(const ViewPixel& p, float (&)[kSums]) const {
    put(p.view, p.x, p.y, p.inverse_depth);
  }
  __device__ double cost(const double (&)[kSums], const float*) const { return 0; }

 private:
  __device__ __forceinline__ void put(int view, int x, int y, float w) const {
    const std::int64_t hypothesis = blockIdx.x / static_cast<unsigned>(bands);
    depth[stride * hypothesis + before[view] + y * width[view] + x] = w;
  }
};

template <bool kPair>
auto kernel_for(const BlockPlan& plan) {
  constexpr Walk kWalk = DepthTerm<kPair>::kStereo ? Walk::pair : Walk::views;
  return plan.vertices_in_shared ? &evaluate_hypotheses<DepthTerm<kPair>, kWalk, true>
                                 : &evaluate_hypotheses<DepthTerm<kPair>, kWalk, false>;
}

}  // namespace

void TileDrawer::prepare(const DeviceObservation& observation) {
  int width = 0, height = 0;
  bool resized = frame_ != observation.frame || pair_ != observation.pair;
  const int views = std::exchange(view_count_, 0);
  pixels_ = 0;
  for (int v = 0; v < kMaxViews; ++v) {
    const TileLayout& tile = observation.tiles[static_cast<std::size_t>(v)].layout;
    if (tile.width == 0) break;  // the views before it are all there are
    ++view_count_;
    resized |= tile.width != widths_[v] || tile.height != heights_[v];
    before_[v] = static_cast<int>(pixels_);
    widths_[v] = tile.width;
    heights_[v] = tile.height;
    pixels_ += std::int64_t{tile.width} * tile.height;
    width = std::max(width, tile.width);
    height = std::max(height, tile.height);
  }
  if (resized || views != view_count_) {
    reserved_ = 0;
    ++revision_;
  }
  frame_ = observation.frame;
  pair_ = observation.pair;
  width_ = width;
  height_ = height;
}

std::int64_t TileDrawer::most_at_once() const {
  const auto bytes = std::max<std::int64_t>(static_cast<std::int64_t>(sizeof(float)) * pixels_, 1);
  return std::max<std::int64_t>(kMostBytes / bytes, 1);
}

void TileDrawer::reserve(const SceneLayout& scene, const DeviceLimits& limits, std::int64_t count) {
  if (count == reserved_) return;
  reserved_ = 0;
  limits_ = limits;
  at_once_ = std::min(most_at_once(), std::max<std::int64_t>(count, 1));
  const auto pixels = static_cast<std::size_t>(at_once_ * pixels_);
  if (pixels > depth_.size()) ++revision_;
  depth_.reserve(pixels);
  plan_ = plan_blocks({.scene = scene,
                       .limits = limits,
                       .count = at_once_,
                       .tile_width = width_,
                       .tile_height = height_,
                       .tiles_at_once = pair_ ? 2 : 1,
                       .sums = 1});
  memory_.reserve(plan_, at_once_, 1, 1);
  if (pair_) {
    allow_shared_memory(kernel_for<true>(plan_), limits);
  } else {
    allow_shared_memory(kernel_for<false>(plan_), limits);
  }
  reserved_ = count;
}

DrawnBatch TileDrawer::enqueue(const SceneLayout& scene, const BatchLayout& batch,
                               std::int64_t first, std::int64_t count, Stream stream) {
  const int point_size = scene.dimension - (batch.prior ? scene.model_count : 0);
  BatchLayout part = batch;
  part.points += first * point_size;
  part.costs += first;
  part.count = count;
  part.add = false;
  const auto draw = [&]<bool kPair>() {
    DepthTerm<kPair> term{};
    term.depth = depth_.data();
    term.stride = pixels_;
    term.bands = plan_.bands;
    term.view_bits = (1 << view_count_) - 1;
    std::copy_n(before_, kMaxViews, term.before);
    std::copy_n(widths_, kMaxViews, term.width);
    launch(kernel_for<kPair>(plan_), dim3(static_cast<unsigned>(count * plan_.bands)),
           dim3(static_cast<unsigned>(plan_.threads)), static_cast<std::size_t>(plan_.shared_bytes),
           stream, overlaps_launches(limits_), scene, frame_, part, plan_, term);
  };
  if (pair_) {
    draw.operator()<true>();
  } else {
    draw.operator()<false>();
  }
  return {.first = static_cast<int>(first),
          .count = static_cast<int>(count),
          .depth = depth_.data(),
          .stride = pixels_};
}

}  // namespace hypotrack::cuda::internal
