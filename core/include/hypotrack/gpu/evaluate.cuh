#pragma once

#include "hypotrack/gpu/bands.cuh"
#include "hypotrack/gpu/block_plan.hpp"
#include "hypotrack/gpu/fill.cuh"
#include "hypotrack/gpu/pose.cuh"
#include "hypotrack/gpu/runtime.cuh"
#include "hypotrack/gpu/score.cuh"
#include "hypotrack/gpu/staging.cuh"
#include "hypotrack/gpu/texels.cuh"

/// The kernel of PixelObjective. One block, or several with bands, poses, draws and scores a
/// hypothesis without leaving its multiprocessor.
namespace hypotrack::cuda {

/// The views that a Term's pixels come from.
enum class Walk { views, pair, general_pair };

/// A range of rows of a pair that a block draws and scores at once.
struct PairPiece {
  Box left, right;  ///< same rows in both
  int last_row;     ///< end of all pieces' rows
  int right_depth;  ///< offset of the right view's z-buffer in shared memory
  TexelLayout texels;
};

/// Data that a block's threads share besides its plan's memory.
struct alignas(16) BlockState {
  FrameLayout frame;
  Bounds bounds;
  VisibleList::Counts counts;
  StagingBarrier staged;
  BandShares shares;
  PairPiece piece;
};

/// The z-buffers to draw into: one view's twice, or those of both views of a pair.
template <bool kShared>
struct DepthBuffers {
  DepthBuffer<kShared> left, right;
};

/// Evaluation of one hypothesis by a block of threads.
template <class Term, Walk kWalk, bool kSharedVertices>
class BlockEvaluation {
 public:
  __device__ BlockEvaluation(const SceneLayout& scene, const BatchLayout& batch,
                             const BlockPlan& plan, const Term& term, BlockState& state)
      : scene_(scene), batch_(batch), plan_(plan), term_(term), state_(state), frame_(state.frame) {
    float* scratch = nullptr;
    if constexpr (!kSharedVertices) {
      scratch = plan.vertex_scratch + std::int64_t{4} * plan.vertex_stride * blockIdx.x;
    }
    vertices_ = {{scratch, plan.vertices}, plan.heights};
  }

  /// Prepares what does not depend on the search point, while the previous kernel may still run.
  /// `frame` must already be valid.
  __device__ void begin(const FrameLayout* frame) {
    Staging staging(state_.staged);
    staging.add(frame, 1, &state_.frame);
    staging.add(scene_.models, scene_.model_count, shared_floats() + plan_.pose.model_layouts);
    staging.add(scene_.bones, scene_.bone_count, shared_floats() + plan_.pose.bone_layouts);
    staging.add(scene_.motions, scene_.motion_count, shared_floats() + plan_.pose.motions);
    if (plan_.stages_vertices) {
      staging.add(scene_.vertices, scene_.vertex_count, shared_floats() + plan_.staged_vertices);
    }
    if (plan_.stages_triangles) {
      staging.add(scene_.triangles, scene_.triangle_count,
                  shared_floats() + plan_.staged_triangles);
    }
    clear(Floats<true>{nullptr, plan_.depth}, plan_.depth_capacity);
    reset();
    staging.finish();
    if (threadIdx.x == 0) state_.shares = shares();
  }

  /// Prepares the block for another run(). All threads call it; the first `threads` of them (more
  /// than a warp) do the work. A barrier must follow.
  __device__ void begin_again(int threads) {
    vertices_are_used_ = depth_is_used_ = lists_are_used_ = false;
    for (float& sum : sums_) sum = 0.0f;
    if (static_cast<int>(threadIdx.x) >= threads) return;
    clear(Floats<true>{nullptr, plan_.depth}, plan_.depth_capacity, threads);
    reset(kWarp);
    if (!stages_again()) return;
    Staging staging(state_.staged, threads);
    staging.add(scene_.vertices, scene_.vertex_count, shared_floats() + plan_.staged_vertices);
    staging.expect();
  }

  /// Reads the block's search point; a barrier must follow.
  __device__ void load() {
    const int size = point_size();
    load_point(batch_.points + hypothesis() * size, size, plan_.pose);
  }

  /// Evaluates the loaded point; `number` counts the calls of begin_again() so far. One thread of
  /// the hypothesis calls outcome.prepare() after posing and outcome.put(cost) at the end.
  template <class Outcome>
  __device__ void run(unsigned number, const Outcome& outcome) {
    pose(scene_, frame_, batch_.prior, plan_.pose);
    if (threadIdx.x == 0 && band() == 0) outcome.prepare();
    if (number > 0 && stages_again()) Staging::wait(state_.staged, number);
    if constexpr (kWalk == Walk::views) {
      for (int v = 0; v < frame_.view_count; ++v) {
        if (term_.views() >> v & 1) single_view(v);
      }
    } else if constexpr (kWalk == Walk::pair) {
      pair();
    } else {
      general_pair();
    }
    finish(outcome);
  }

  __device__ std::int64_t hypothesis() const {
    return blockIdx.x / static_cast<unsigned>(plan_.bands);
  }
  __device__ int band() const {
    return static_cast<int>(blockIdx.x % static_cast<unsigned>(plan_.bands));
  }

 private:
  __device__ int point_size() const {
    return scene_.dimension - (batch_.prior ? scene_.model_count : 0);
  }

  /// Returns true if run() overwrites the staged vertices with texels.
  __device__ bool stages_again() const {
    return HasTexels<Term> && plan_.stages_vertices && !plan_.keeps_vertices;
  }

  __device__ void reset(int thread = 0) {
    if (static_cast<int>(threadIdx.x) != thread) return;
    state_.bounds.reset();
    state_.counts.reset();
  }

  /// Skins and projects all vertices into a view and, with kPair, the second view. On return the
  /// bounds are valid for the whole block.
  template <bool kPair>
  __device__ __forceinline__ void place_vertices(int view) {
    const float* bones = shared_floats() + plan_.pose.bones;
    // The second view of a pair is projected through the first even if drawn alone, as on the CPU.
    const bool of_pair = kPair || frame_.pair != 0;
    const bool second = !kPair && of_pair && view == 1;
    const ViewLayout& camera = frame_.views[of_pair ? 0 : view];
    const Parallax parallax = pair_parallax();
    ThreadBounds own;
    const Staged<VertexWords> layouts{reinterpret_cast<const VertexWords*>(scene_.vertices),
                                      plan_.staged_vertices, plan_.stages_vertices};
    const int threads = static_cast<int>(blockDim.x);
#pragma unroll 1  // keeps the code short
    for (int round = 0; round * threads < scene_.vertex_count; ++round) {
      // Vertices with many bones come first; alternating directions balance the threads.
      const int thread = static_cast<int>(threadIdx.x);
      const int i = round * threads + (round % 2 == 0 ? thread : threads - 1 - thread);
      if (i >= scene_.vertex_count) continue;
      const float3 v = project<kPair>(skin(layouts[i], bones), camera, of_pair || view == 0);
      const float x2 = of_pair ? parallax(v.x, v.z) : 0.0f, x = second ? x2 : v.x;
      const bool valid = v.z > 0.0f && fabsf(x2) <= kFarthestPixel;
      vertices_.put(i, {x, v.y, valid ? v.z : 0.0f, x2});
      if (valid) own.add(x, x2, v.y);
    }
    own.join(state_.bounds, kPair);
    __syncthreads();
  }

  __device__ Parallax pair_parallax() const {
    const ViewLayout* v = frame_.views;
    return {v[1].cx - v[0].cx, v[1].fx * v[1].view_from_first[3]};
  }

  /// Draws all triangles into cleared z-buffers of `view` or, with kPair, of both views. A barrier
  /// must precede and follow. `rows` are the z-buffers' rows. The whole block calls
  /// `buffers(is_first)` for the z-buffers before it fills each chunk.
  template <bool kPair, bool kSharedDepth, class Buffers>
  __device__ void draw(int view, const Span& rows, const Buffers& buffers) {
    const VisibleList list{reinterpret_cast<std::uint16_t*>(shared_floats() + plan_.list),
                           2 * plan_.chunk, &state_.counts};
    const ViewLayout* views = frame_.views + view;  // the view after the last is not read
#pragma unroll 1                                    // keeps the code short
    for (int first = 0; first < scene_.triangle_count; first += plan_.chunk) {
      const int count = min(plan_.chunk, scene_.triangle_count - first);
      if (first > 0) __syncthreads();
      if (first > 0 || lists_are_used_) {
        if (threadIdx.x == 0) state_.counts.reset();
        __syncthreads();
      }
      lists_are_used_ = true;
      constexpr int kWords = sizeof(PackedTriangle) / sizeof(float);
      const Staged<PackedTriangle> triangles{scene_.triangles + first,
                                             plan_.staged_triangles + kWords * first,
                                             plan_.stages_triangles};
      cull<kPair>(triangles, vertices_, views[0].width, views[1].width, rows.first, rows.last,
                  count, list);
      __syncthreads();
      const DepthBuffers<kSharedDepth> depth = buffers(first == 0);
      const Filler<kPair, kSharedVertices, kSharedDepth> filler{
          triangles,       vertices_,  views[0].width, views[1].width,
          views[0].height, depth.left, depth.right};
      filler.few(list);
      filler.many(list);
    }
  }

  /// Returns the shares of work where this block's band begins and ends.
  __device__ BandShares shares() const {
    // With uncovered pixels visited, all rows cost about the same.
    if (Term::kVisitsUncovered) return even_shares(band(), plan_.bands);
    return {share_before(frame_.work_ends, band(), plan_.bands),
            share_before(frame_.work_ends, band() + 1, plan_.bands)};
  }

  /// Returns the rows of y0 <= y < y1 that belong to this block's band.
  __device__ Span band(int y0, int y1) const {
    const Span rows = {y0, y1};
    return {row_at(rows, state_.shares.before), row_at(rows, state_.shares.after)};
  }

  /// Splits rows first .. last - 1 into pieces whose z-buffers, `width` pixels wide, fit into
  /// shared memory. Calls piece(y0, y1) for each.
  template <class Piece>
  __device__ void in_pieces(const Span& rows, int width, const Piece& piece) {
    if (width <= 0) return;
    const int most = small_quotient(plan_.depth_capacity - 4, width);
#pragma unroll 1  // keeps the code short
    for (int y0 = rows.first; y0 < rows.last; y0 += most) {
      if (y0 > rows.first || depth_is_used_) {
        __syncthreads();
        clear(Floats<true>{nullptr, plan_.depth}, plan_.depth_capacity);
        __syncthreads();
      }
      depth_is_used_ = true;
      piece(y0, min(y0 + most, rows.last));
    }
  }

  __device__ void single_view(int view) {
    if (vertices_are_used_) {
      __syncthreads();
      reset();
      __syncthreads();
    }
    place_vertices<false>(view);
    vertices_are_used_ = true;
    const ViewLayout& camera = frame_.views[view];
    Box box = state_.bounds.box(camera.width, camera.height);
    if (box.empty()) box = {0, 0, 0, 0};
    if (Term::kVisitsUncovered) box = {0, 0, camera.width, camera.height};
    in_pieces(band(box.y0, box.y1), box.width(), [&](int y0, int y1) {
      const DepthBuffer<true> buffer{{nullptr, plan_.depth}, {box.x0, y0, box.x1, y1}};
      draw<false, true>(view, {y0, y1}, [&](bool) { return DepthBuffers<true>{buffer, buffer}; });
      __syncthreads();
      score_view(term_, view, buffer.box, buffer, sums_);
    });
  }

  __device__ void pair() {
    place_vertices<true>(0);
    bool first = true;
#pragma unroll 1  // keeps the code short
    do {
      if (!first) {
        __syncthreads();
        clear(Floats<true>{nullptr, plan_.depth}, plan_.depth_capacity);
      }
      // One thread computes what is equal for all; the others would only serialise. What culling
      // does not need is computed while the others cull.
      if (threadIdx.x == 0) next_boxes(first);
      first = false;
      __syncthreads();
      const PairPiece& piece = state_.piece;
      if (piece.left.empty() && piece.right.empty()) break;
      if (threadIdx.x == 0) lay_out_texels();
      const auto buffers = [&] {
        return DepthBuffers<true>{{{nullptr, plan_.depth}, piece.left},
                                  {{nullptr, piece.right_depth}, piece.right}};
      };
      using Texels = SharedTexels<Term>;
      draw<true, true>(0, {piece.left.y0, piece.left.y1}, [&](bool is_first) {
        if (is_first) Texels::fetch(term_, frame_, piece.texels);
        return buffers();
      });
      Texels::wait();
      __syncthreads();
      const DepthBuffers<true> depth = buffers();
      if (piece.texels.fits) {
        score_both<true>(depth.left, depth.right, Texels(piece.texels));
      } else {
        score_both<true>(depth.left, depth.right, TileTexels<Term>(term_, frame_));
      }
    } while (state_.piece.left.y1 < state_.piece.last_row);
  }

  /// Computes the boxes of the band's first or next piece; called by one thread.
  __device__ void next_boxes(bool first) {
    PairPiece& piece = state_.piece;
    Box left = piece.left, right = piece.right;
    int y0 = left.y1, last_row = piece.last_row;
    if (first) {
      const ViewLayout* v = frame_.views;
      left = state_.bounds.box(v[0].width, v[0].height);
      right = state_.bounds.box2(v[1].width, v[1].height);
      if (left.empty()) left.x0 = left.x1 = 0;  // an empty box may lie anywhere
      if (right.empty()) right.x0 = right.x1 = 0;
      if (Term::kVisitsUncovered) {
        left = {0, 0, v[0].width, v[0].height};
        right = {0, 0, v[1].width, v[1].height};
      }
      const Span rows = band(left.y0, left.y1);
      y0 = rows.first;
      last_row = rows.last;
    }
    const int width = left.width() + right.width();
    const int most = width > 0 ? small_quotient(plan_.depth_capacity - 4, width) : 0;
    left.y0 = right.y0 = y0;
    left.y1 = right.y1 = width > 0 ? min(y0 + most, last_row) : y0;
    piece.left = left;
    piece.right = right;
    piece.last_row = width > 0 ? last_row : y0;
  }

  /// Places the z-buffers and texels of the piece's boxes; called by one thread.
  __device__ void lay_out_texels() {
    PairPiece& piece = state_.piece;
    const int rows = piece.left.height(), left = piece.left.width() * rows;
    const int end = plan_.depth + padded(left + piece.right.width() * rows);
    piece.right_depth = plan_.depth + left;
    piece.texels = SharedTexels<Term>::lay_out(frame_, piece.left, piece.right, end, plan_.end);
  }

  template <bool kRectified, bool kSharedDepth, class Texels>
  __device__ void score_both(const DepthBuffer<kSharedDepth>& left,
                             const DepthBuffer<kSharedDepth>& right, const Texels& texels) {
    const int directions = term_.directions();
    if (directions & 1) {
      score_stereo<0, kRectified>(term_, frame_.maps[0], left.box, left, right, texels, sums_);
    }
    if (directions & 2) {
      score_stereo<1, kRectified>(term_, frame_.maps[1], right.box, right, left, texels, sums_);
    }
  }

  /// Evaluates two unrectified views. Both z-buffers exist at once, in global memory if necessary.
  __device__ void general_pair() {
    const Box right = place_alone(1), left = place_alone(0);
    const int left_size = padded(left.width() * left.height());
    const int right_size = padded(right.width() * right.height());
    if (left_size + right_size <= plan_.depth_capacity) {
      draw_and_score(DepthBuffer<true>{{nullptr, plan_.depth}, left},
                     DepthBuffer<true>{{nullptr, plan_.depth + left_size}, right});
      return;
    }
    const Floats<false> depth{
        plan_.depth_scratch + std::int64_t{plan_.depth_scratch_size} * blockIdx.x, 0};
    clear(depth, left_size + right_size);
    __syncthreads();
    draw_and_score(DepthBuffer<false>{depth, left},
                   DepthBuffer<false>{{depth.global, left_size}, right});
  }

  __device__ static int padded(int floats) { return (floats + 3) / 4 * 4; }

  /// Places the vertices of one view and returns its box.
  __device__ Box place_alone(int view) {
    if (vertices_are_used_) {
      __syncthreads();
      reset();
      __syncthreads();
    }
    vertices_are_used_ = true;
    place_vertices<false>(view);
    const ViewLayout& camera = frame_.views[view];
    if (Term::kVisitsUncovered) return {0, 0, camera.width, camera.height};
    const Box box = state_.bounds.box(camera.width, camera.height);
    return box.empty() ? Box{0, 0, 0, 0} : box;
  }

  template <bool kSharedDepth>
  __device__ void draw_alone(int view, const DepthBuffer<kSharedDepth>& depth) {
    draw<false, kSharedDepth>(view, {depth.box.y0, depth.box.y1}, [&](bool) {
      return DepthBuffers<kSharedDepth>{depth, depth};
    });
  }

  /// Draws both views and scores them. The vertices must be placed for view 0.
  template <bool kSharedDepth>
  __device__ void draw_and_score(const DepthBuffer<kSharedDepth>& left,
                                 const DepthBuffer<kSharedDepth>& right) {
    draw_alone(0, left);
    place_alone(1);
    draw_alone(1, right);
    __syncthreads();
    score_both<false>(left, right, TileTexels<Term>(term_, frame_));
  }

  template <class Outcome>
  __device__ void finish(const Outcome& outcome) {
    double total[Term::kSums];
    block_sum(sums_, shared_floats() + plan_.sums, total);
    if (threadIdx.x >= kWarp) return;
    if (plan_.bands > 1) {
      constexpr int kSums = Term::kSums;
      double* slots = plan_.band_sums + hypothesis() * (plan_.bands * kSums);
      auto* room = reinterpret_cast<double*>(shared_floats() + plan_.sums);
      if (!join_bands<kSums>(slots, band(), plan_.bands, room, total)) return;
    }
    if (threadIdx.x > 0) return;
    outcome.put(batch_.weight * term_.cost(total, shared_floats() + plan_.pose.state));
  }

  const SceneLayout& scene_;
  const BatchLayout& batch_;
  const BlockPlan& plan_;
  const Term& term_;
  BlockState& state_;
  const FrameLayout& frame_;
  Vertices<kSharedVertices> vertices_;
  bool vertices_are_used_ = false;
  bool depth_is_used_ = false;
  bool lists_are_used_ = false;
  float sums_[Term::kSums] = {};
};

/// Writes or adds a cost to a batch.
struct CostOfBatch {
  const BatchLayout& batch;
  std::int64_t hypothesis;
  __device__ void prepare() const {}
  __device__ void put(double cost) const {
    double& out = batch.costs[hypothesis];
    out = batch.add ? __ldcg(&out) + cost : cost;
  }
};

template <class Term, Walk kWalk, bool kSharedVertices>
__global__ void __launch_bounds__(kMostThreads)
    evaluate_hypotheses(const __grid_constant__ SceneLayout scene, const FrameLayout* frame,
                        const __grid_constant__ BatchLayout batch,
                        const __grid_constant__ BlockPlan plan, const __grid_constant__ Term term) {
  __shared__ BlockState state;
  BlockEvaluation<Term, kWalk, kSharedVertices> block(scene, batch, plan, term, state);
  block.begin(frame);
  wait_for_previous();
  let_next_start();
  block.load();
  __syncthreads();
  block.run(0, CostOfBatch{batch, block.hypothesis()});
}

}  // namespace hypotrack::cuda
