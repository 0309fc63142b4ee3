#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <set>
#include <type_traits>

#include "hypotrack/gpu/block_memory.cuh"
#include "hypotrack/gpu/drawn.cuh"
#include "hypotrack/gpu/evaluate.cuh"
#include "hypotrack/gpu/pixel_residuals.cuh"
#include "hypotrack/gpu/swarm_search.cuh"

namespace hypotrack::cuda {

/// A device objective that is a sum over pixels. A plugin writes a Term and derives from
/// PixelObjective<Term> in a .cu file:
///
///   struct MyTerm {                                    // trivially copyable
///     static constexpr bool kStereo = true;            // true: pixels of a reference view with
///                                                      // their match in the other
///     static constexpr bool kVisitsUncovered = false;  // true: visit uncovered pixels as well
///     static constexpr int kSums = 2;
///     const float* feature;                            // device memory
///     float tolerance;                                 // kStereo: largest depth difference of one
///                                                      // surface in both views, metres
///     __device__ int directions() const;               // kStereo: bit v: view v is a reference
///     template <int kReference>
///     __device__ void pixel(const StereoPixel& p, float (&sums)[kSums]) const;
///
///     // kStereo, with a lookup per pixel of the tiles. The block caches these texels and passes
///     // them to pixel() as `texels`. texels.template at<view>(x, y) is valid for pixels covered
///     // in that view and their neighbours in x within its tile.
///     using Texel = uint2;                             // 4, 8 or 16 bytes
///     __device__ const Texel* texels(int view) const;  // rows without gaps, aligned to 16 bytes
///     template <int kReference, class Texels>
///     __device__ void pixel(const StereoPixel& p, const Texels& texels,
///                           float (&sums)[kSums]) const;
///
///     // Instead of these if kStereo is false:
///     __device__ int views() const;                    // bit v: view v is visited
///     __device__ void pixel(const ViewPixel& p, float (&sums)[kSums]) const;
///
///     // Called once per hypothesis; `state` is decoded and normalised:
///     __device__ double cost(const double (&sums)[kSums], const float* state) const;
///
///     // If the objective has residuals (ResidualTerm): one per pixel of the visited views.
///     // pixel() then returns that of its pixel as a float. uncovered_residual() returns that of
///     // an uncovered pixel, the i-th of the view's tile row by row. views() or directions() are
///     // then HYPOTRACK_PIXEL, for the host as well.
///     __device__ float uncovered_residual(int view, int i) const;
///     // If they have slopes d residual / d(1/z) (ResidualTerm::write_slopes()): that of a covered
///     // pixel. `map` is that to the other view. Any pixel of `texels` may be read.
///     template <int kReference, class Texels>                        // if kStereo
///     __device__ float slope(const StereoPixel& p, const StereoMap& map,
///                            const Texels& texels) const;
///     __device__ float slope(const ViewPixel& p) const;              // otherwise
///     // If the state has residuals; they follow those of the pixels:
///     HYPOTRACK_PIXEL int state_residual_count() const;
///     __device__ float state_residual(int i, const float* state) const;
///   };
///
/// A thread sums in single precision. The block joins its threads' sums in a fixed order in double
/// precision, so that equal hypotheses have equal costs. A change of a Term's bytes forces captured
/// graphs to be captured again. So data that changes every frame belongs in device memory that a
/// kernel of make_term() writes.
template <class Term>
class PixelObjective : public DeviceObjective {
 public:
  static_assert(std::is_trivially_copyable_v<Term>, "a Term is copied to the device as it is");

  void prepare(const DeviceObservation& observation, Stream stream) final {
    Term term = make_term(observation, stream);
    if constexpr (!std::is_empty_v<Term>) __builtin_clear_padding(&term);
    if (frame_ != observation.frame || differ(term, term_)) ++revision_;
    frame_ = observation.frame;
    term_ = term;
    int width = 0, height = 0;
    bool resized = observation.pair != rectified_;
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
      const TileLayout& tile = observation.tiles[i].layout;
      resized |= tile.width != tiles_[i].width || tile.height != tiles_[i].height;
      tiles_[i] = tile;
      width = std::max(width, tile.width);
      height = std::max(height, tile.height);
    }
    if (resized) {
      reserved_ = 0;
      ++revision_;
    }
    width_ = width;
    height_ = height;
    rectified_ = observation.pair;
  }

  void reserve(const SceneLayout& scene, const DeviceLimits& limits, std::int64_t count) final {
    if (count == reserved_) return;
    reserved_ = 0;
    limits_ = limits;
    BlockPlan plan = plan_blocks(plan_request(scene, count));
    if (plan.depth_capacity < least_depth_capacity(Term::kStereo ? 2 : 1, width_)) {
      throw DeviceError("CUDA: tiles " + std::to_string(width_) +
                        " pixels wide and this scene's bones do not fit into the device's shared "
                        "memory; use smaller tiles, or backend: cpu");
    }
    const int both_tiles = 2 * detail::rounded(width_ * height_);
    if (Term::kStereo && !rectified_ && both_tiles > plan.depth_capacity) {
      plan.depth_scratch_size = both_tiles;
    }
    // Blocks wait for one another, so all of them must run at once; twice as many would.
    drawn_bands_ = static_cast<int>(
        std::clamp<std::int64_t>(2 * limits.multiprocessors / count, 1, kMostBands));
    // A plan depends on nothing else that changes, so that a batch of an earlier size has its plan.
    memory_.reserve(plan, count, drawn_bands_, Term::kSums);
    allow_shared(kernel_for<Term>(plan));
    plan_ = plan;
    searching_blocks_ = kUnknown;
    reserved_ = count;
  }

  void enqueue(const SceneLayout& scene, const BatchLayout& batch, Stream stream) final {
    const auto blocks = static_cast<unsigned>(batch.count * plan_.bands);
    launch(kernel_for<Term>(plan_), dim3(blocks), dim3(static_cast<unsigned>(plan_.threads)),
           static_cast<std::size_t>(plan_.shared_bytes), stream, overlaps_launches(limits_), scene,
           frame_, batch, plan_, term_);
  }

  bool enqueue_search(const SceneLayout& scene, const BatchLayout& batch, const SwarmSearch& search,
                      Stream stream) final {
    if (searching_blocks_ == kUnknown) plan_search(scene);
    const std::int64_t blocks = batch.count * search_plan_.bands;
    if (blocks > searching_blocks_) return false;
    launch_together(search_kernel(), dim3(static_cast<unsigned>(blocks)),
                    dim3(static_cast<unsigned>(search_plan_.threads)),
                    static_cast<std::size_t>(search_plan_.shared_bytes), stream, scene, frame_,
                    batch, search_plan_, term_, search);
    return true;
  }

  bool has_residuals() const final { return HasResiduals<Term>; }

  std::int64_t residual_count() const final {
    if constexpr (HasResiduals<Term>) {
      std::int64_t count = state_residual_count(term_);
      for (std::size_t i = 0; i < tiles_.size(); ++i) {
        if (views_of(term_) >> i & 1) count += std::int64_t{tiles_[i].width} * tiles_[i].height;
      }
      return count;
    } else {
      return 0;
    }
  }

  void enqueue_drawn(const SceneLayout& scene, const BatchLayout& batch, const DrawnBatch& drawn,
                     Stream stream) final {
    score_drawn(scene, batch, drawn, NoResiduals{}, stream);
  }

  void enqueue_residuals(const SceneLayout& scene, const BatchLayout& batch,
                         const DrawnBatch& drawn, const ResidualLayout& residuals,
                         Stream stream) final {
    if constexpr (HasResiduals<Term>) {
      score_drawn(scene, batch, drawn, places(residuals), stream);
    } else {
      DeviceObjective::enqueue_residuals(scene, batch, drawn, residuals, stream);
    }
  }

  bool has_slopes() const final { return HasSlopes<Term>; }

  void enqueue_slopes(const SceneLayout& scene, const DrawnBatch& drawn, const SlopeLayout& slopes,
                      Stream stream) final {
    if constexpr (HasSlopes<Term>) {
      const int rows = kDrawnThreads / std::max(width_, 1) + 1;
      launch(&write_drawn_slopes<Term>,
             dim3(static_cast<unsigned>((height_ + rows - 1) / rows),
                  static_cast<unsigned>(drawn.count)),
             dim3(kDrawnThreads), 0, stream, overlaps_launches(limits_), frame_, drawn, term_,
             slopes);
    } else {
      DeviceObjective::enqueue_slopes(scene, drawn, slopes, stream);
    }
  }

  std::uint64_t revision() const final { return revision_ + memory_.revision(); }

 protected:
  /// Enqueues the kernels that make a frame's features and returns the Term that reads them. Throws
  /// DataError if the observation does not suit.
  virtual Term make_term(const DeviceObservation& observation, Stream stream) = 0;

 private:
  static constexpr std::int64_t kUnknown = -1;

  PlanRequest plan_request(const SceneLayout& scene, std::int64_t count) const {
    return {.scene = scene,
            .limits = limits_,
            .count = count,
            .tile_width = width_,
            .tile_height = height_,
            .tiles_at_once = Term::kStereo ? 2 : 1,
            .may_split = !Term::kStereo || rectified_,
            .sums = Term::kSums,
            .texels = HasTexels<Term>};
  }

  /// Plans a whole search as one kernel for the reserved number of hypotheses.
  void plan_search(const SceneLayout& scene) {
    searching_blocks_ = 0;
    if (!plan_.vertices_in_shared || (Term::kStereo && !rectified_)) return;
    allow_shared(search_kernel());
    PlanRequest request = plan_request(scene, reserved_);
    request.alone = true;
    search_plan_ = plan_blocks(request);
    search_plan_.band_sums = plan_.band_sums;
    searching_blocks_ = blocks_at_once(search_kernel(), search_plan_.threads,
                                       static_cast<std::size_t>(search_plan_.shared_bytes),
                                       limits_.multiprocessors);
  }

  template <class To>
  void score_drawn(const SceneLayout& scene, const BatchLayout& batch, const DrawnBatch& drawn,
                   const To& to, Stream stream) {
    const auto run = [&](auto kernel, int bands) {
      launch(kernel, dim3(static_cast<unsigned>(drawn.count * bands)), dim3(kDrawnThreads),
             sizeof(float) * static_cast<std::size_t>(plan_.list),  // all before `list`
             stream, overlaps_launches(limits_), scene, frame_, batch, plan_, bands, drawn, term_,
             to);
    };
    if (drawn.texture != 0) {
      run(&score_drawn_hypotheses<Term, To, true>, 1);
    } else {
      run(&score_drawn_hypotheses<Term, To, false>, drawn_bands_);
    }
  }

  template <class AnyTerm>
  using Kernel = void (*)(SceneLayout, const FrameLayout*, BatchLayout, BlockPlan, AnyTerm);

  template <class AnyTerm>
  Kernel<AnyTerm> kernel_for(const BlockPlan& plan) const {
    const auto with = [&](auto walk) -> Kernel<AnyTerm> {
      constexpr Walk kWalk = decltype(walk)::value;
      return plan.vertices_in_shared ? &evaluate_hypotheses<AnyTerm, kWalk, true>
                                     : &evaluate_hypotheses<AnyTerm, kWalk, false>;
    };
    if constexpr (Term::kStereo) {
      if (rectified_) return with(std::integral_constant<Walk, Walk::pair>());
      return with(std::integral_constant<Walk, Walk::general_pair>());
    } else {
      return with(std::integral_constant<Walk, Walk::views>());
    }
  }

  /// Returns the search kernel for rectified pairs and for views.
  static auto search_kernel() {
    return &search_with_swarm < Term, Term::kStereo ? Walk::pair : Walk::views > ;
  }

  /// Raises a kernel's shared-memory limit to the most that a plan may use.
  template <class AnyKernel>
  void allow_shared(AnyKernel* kernel) {
    if (!allowed_.insert(reinterpret_cast<const void*>(kernel)).second) return;
    allow_shared_memory(kernel, limits_);
    check(cudaFuncSetAttribute(kernel, cudaFuncAttributePreferredSharedMemoryCarveout,
                               cudaSharedmemCarveoutMaxShared),
          "choosing shared memory over cache");
  }

  /// Returns the residuals' addresses, view by view, in the order of the CPU's residuals.
  ResidualPlaces places(const ResidualLayout& layout) const {
    ResidualPlaces to{};
    to.stride = layout.stride;
    to.factor = layout.factor;
    float* next = layout.residuals;
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
      to.width[i] = tiles_[i].width;
      if (!(views_of(term_) >> i & 1)) continue;
      to.views[i] = next;
      next += std::int64_t{tiles_[i].width} * tiles_[i].height;
    }
    to.state = next;
    return to;
  }
  static bool differ(const Term& a, const Term& b) {
    if constexpr (std::is_empty_v<Term>) {
      return false;
    } else {
      return std::memcmp(&a, &b, sizeof a) != 0;
    }
  }

  Term term_{};
  const FrameLayout* frame_ = nullptr;
  std::array<TileLayout, kMaxViews> tiles_{};  // absent views are empty
  int width_ = 0, height_ = 0;
  bool rectified_ = false;
  DeviceLimits limits_;
  std::int64_t reserved_ = 0;
  /// Most blocks of a search in one kernel; 0 = unavailable.
  std::int64_t searching_blocks_ = kUnknown;
  int drawn_bands_ = 1;  ///< blocks per drawn hypothesis
  std::uint64_t revision_ = 0;
  BlockPlan plan_, search_plan_;
  BlockMemory memory_;
  std::set<const void*> allowed_;  // kernels
};

}  // namespace hypotrack::cuda
