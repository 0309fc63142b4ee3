#include "cost/cuda/linearize/pixel_rows.hpp"

#include <algorithm>

#include "hypotrack/gpu/block_memory.cuh"
#include "hypotrack/gpu/cull.cuh"
#include "hypotrack/gpu/drawn.cuh"
#include "hypotrack/gpu/pose.cuh"
#include "hypotrack/gpu/runtime.cuh"
#include "hypotrack/gpu/vertices.cuh"

namespace hypotrack::cuda::internal {
namespace {

constexpr int kPoseThreads = 512;
constexpr int kTriangleThreads = 256;
constexpr int kRowThreads = 256;
constexpr int kRowWarps = kRowThreads / kWarp;
constexpr int kPixelsPerWarp = 8;  // few, so that many warps share the rows
// Blocks that share the pixels of a point: about 1,024 for all points together.
constexpr int kAllRowBlocks = 1024, kLeastRowBlocks = 64, kMostRowBlocks = 512;
constexpr int kJoinWarps = 8;
constexpr std::uint32_t kNoTriangle = ~0u;

// As in cost/linearize/pixel_rows.cpp.
constexpr float kStep = 0.006f;
constexpr float kInside = 2e-5f;
constexpr float kSameDepth = 1e-5f;

__device__ int sets_of(const PixelRowsJob& job) { return job.pair ? 1 : job.view_count; }

/// Returns whether a point's sums stay as they are; call it after wait_for_previous().
__device__ bool rests(const PixelRowsJob& job, int point) {
  return job.rests && __ldcg(job.rests + point) != 0;
}

/// Returns the records of a point and set of vertices: for each vertex, x, y, 1/z and x in the
/// second view of a pair, of all states.
__device__ float4* records_of(const PixelRowsJob& job, const SceneLayout& scene, int point,
                              int set) {
  const std::int64_t before = std::int64_t{point} * sets_of(job) + set;
  return reinterpret_cast<float4*>(job.records) + before * scene.vertex_count * (job.columns + 1);
}

/// A view's vertices of a point of linearisation.
class Records {
 public:
  __device__ Records(const PixelRowsJob& job, const SceneLayout& scene, int point, int view)
      : first_(records_of(job, scene, point, job.pair ? 0 : view)),
        pitch_(job.columns + 1),
        second_(job.pair && view == 1) {}
  /// Returns x, y and 1/z of a vertex; state 0 is the drawn one.
  __device__ __forceinline__ float3 operator()(int vertex, int state) const {
    const float4 r = __ldcg(first_ + std::int64_t{vertex} * pitch_ + state);
    return {second_ ? r.w : r.x, r.y, r.z};
  }

 private:
  const float4* first_;
  int pitch_;
  bool second_;
};

/// Poses and projects the vertices of one state per block: blocks in y are points, those in x the
/// states of each. Clears the owners.
__global__ void __launch_bounds__(kPoseThreads)
    place_states(const __grid_constant__ SceneLayout scene,
                 const __grid_constant__ PixelRowsJob job, PoseMemory at) {
  wait_for_previous();
  let_next_start();
  const int thread = static_cast<int>(threadIdx.x), state = static_cast<int>(blockIdx.x);
  const int point = static_cast<int>(blockIdx.y), pitch = job.columns + 1;
  if (rests(job, point)) return;
  copy_to_shared(scene.models, scene.model_count, at.model_layouts);
  copy_to_shared(scene.bones, scene.bone_count, at.bone_layouts);
  copy_to_shared(scene.motions, scene.motion_count, at.motions);
  load_point(job.states + (std::int64_t{point} * pitch + state) * scene.dimension, scene.dimension,
             at);
  __syncthreads();
  const FrameLayout& frame = *job.frame;
  pose(scene, frame, nullptr, at);
  const float* bones = shared_floats() + at.bones;
  const auto* vertices = reinterpret_cast<const VertexWords*>(scene.vertices);
  const Parallax parallax{frame.views[1].cx - frame.views[0].cx,
                          frame.views[1].fx * frame.views[1].view_from_first[3]};
  for (int i = thread; i < scene.vertex_count; i += kPoseThreads) {
    const float3 p = skin(vertices[i], bones);
    for (int set = 0; set < sets_of(job); ++set) {
      const float3 v = project<false>(p, frame.views[set], set == 0);
      const float x2 = job.pair ? parallax(v.x, v.z) : 0.0f;
      const bool valid = v.z > 0.0f && fabsf(x2) <= kFarthestPixel;
      records_of(job, scene, point, set)[std::int64_t{i} * pitch + state] = {
          v.x, v.y, valid ? v.z : 0.0f, x2};
    }
  }
  const int all = static_cast<int>(gridDim.x) * kPoseThreads;
  for (int i = state * kPoseThreads + thread; i < job.pixels; i += all) {
    job.owners[std::int64_t{point} * job.pixels + i] = kNoTriangle;
  }
}

/// A triangle seen from one pixel: barycentric coordinates there, 1/z and its gradient.
struct TriangleAtPixel {
  float share_a, share_b, share_c;
  float w, w_dx, w_dy;

  __device__ __forceinline__ TriangleAtPixel(const float3& a, const float3& b, const float3& c,
                                             float x, float y) {
    const float ax = a.x - x, bx = b.x - x, cx = c.x - x;
    const float ay = a.y - y, by = b.y - y, cy = c.y - y;
    const float scale = 1.0f / ((bx - ax) * (cy - ay) - (cx - ax) * (by - ay));
    share_a = (bx * cy - cx * by) * scale;
    share_b = (cx * ay - ax * cy) * scale;
    share_c = 1.0f - share_a - share_b;
    const float w_ac = a.z - c.z, w_bc = b.z - c.z;
    w = c.z + share_a * w_ac + share_b * w_bc;
    w_dx = ((by - cy) * w_ac + (cy - ay) * w_bc) * scale;
    w_dy = ((cx - bx) * w_ac + (ax - cx) * w_bc) * scale;
  }
  __device__ __forceinline__ bool covers() const {
    return fminf(fminf(share_a, share_b), share_c) >= -kInside;
  }
};

/// Finds the triangle of every pixel: the first one of the triangles drawn there. A warp takes a
/// triangle in a view; blocks in y are points.
__global__ void __launch_bounds__(kTriangleThreads)
    find_owners(const __grid_constant__ SceneLayout scene,
                const __grid_constant__ PixelRowsJob job) {
  wait_for_previous();
  let_next_start();
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  const int warp = static_cast<int>((blockIdx.x * kTriangleThreads + threadIdx.x) / kWarp);
  const int view = warp / scene.triangle_count, number = warp % scene.triangle_count;
  const int point = static_cast<int>(blockIdx.y);
  if (view >= job.view_count || rests(job, point)) return;
  const PackedTriangle packed = scene.triangles[number];
  const TriangleCorners corners(packed);
  const Records records(job, scene, point, view);
  const float3 a = records(corners.a, 0), b = records(corners.b, 0), c = records(corners.c, 0);
  if (!(least(a.z, b.z, c.z) > 0.0f)) return;
  const float area = -twice_area({a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z});
  const bool two_sided = (packed >> (3 * kVertexBits)) != 0;
  if (!((two_sided ? fabsf(area) : area) > kSmallestArea)) return;
  const ViewLayout& camera = job.frame->views[view];
  const Span columns = pixel_span(a.x, b.x, c.x, camera.width);
  const Span rows = pixel_span(a.y, b.y, c.y, camera.height);
  const int width = columns.last - columns.first + 1, height = rows.last - rows.first + 1;
  if (width <= 0 || height <= 0) return;
  const std::int64_t before = std::int64_t{point} * job.pixels + pixels_before(*job.frame, view);
  for (int i = lane; i < width * height; i += kWarp) {
    const int x = columns.first + i % width, y = rows.first + i / width;
    const TriangleAtPixel at(a, b, c, static_cast<float>(x), static_cast<float>(y));
    const std::int64_t place = before + y * camera.width + x;
    if (!at.covers() || !(at.w >= __ldcg(job.depth + place) * (1.0f - kSameDepth))) continue;
    atomicMin(job.owners + place, static_cast<std::uint32_t>(number));
  }
}

/// A row of J before the motions of its corners are known: sum over the corners k of
/// share[k] (along . motion of k).
struct RowShape {
  float share[3];
  float3 along;
  float residual;
};

/// What one thread knows about its pixel.
struct PixelRowShapes {
  static constexpr int kSides = 4;  // left, right, above, below

  int view = 0, corner[3] = {};
  float share[3] = {};
  float w_dx = 0, w_dy = 0;
  float slope = 0, residual = 0;                    // of all terms together; slope 0: no row
  float change[kSides] = {}, product[kSides] = {};  // change 0: no silhouette on that side

  __device__ PixelRowShapes(const SceneLayout& scene, const PixelRowsJob& job, int point,
                            int pixel) {
    if (pixel >= job.pixels) return;
    const std::int64_t first = std::int64_t{point} * job.pixels;
    const std::uint32_t owner = __ldcg(job.owners + first + pixel);
    if (owner == kNoTriangle) return;
    const FrameLayout& frame = *job.frame;
    int before = 0;
    while (pixel >= before + frame.views[view].width * frame.views[view].height) {
      before += frame.views[view].width * frame.views[view].height;
      ++view;
    }
    const int width = frame.views[view].width, height = frame.views[view].height;
    const int x = (pixel - before) % width, y = (pixel - before) / width;
    const TriangleCorners corners(scene.triangles[owner]);
    corner[0] = corners.a, corner[1] = corners.b, corner[2] = corners.c;
    const Records records(job, scene, point, view);
    const TriangleAtPixel at(records(corners.a, 0), records(corners.b, 0), records(corners.c, 0),
                             static_cast<float>(x), static_cast<float>(y));
    share[0] = at.share_a, share[1] = at.share_b, share[2] = at.share_c;
    w_dx = at.w_dx, w_dy = at.w_dy;
    // On a surface seen at a grazing angle, a small motion moves the pixel far along it.
    const Pixel here{job, point, pixel};
    if (!(fmaxf(fabsf(w_dx), fabsf(w_dy)) > kStep * at.w * at.w)) join_terms(here);
    if (x > 0) find_edge(here, 0, -1, at.w);
    if (x + 1 < width) find_edge(here, 1, 1, at.w);
    if (y > 0) find_edge(here, 2, -width, at.w);
    if (y + 1 < height) find_edge(here, 3, width, at.w);
  }

  __device__ RowShape surface() const {
    return {{slope * share[0], slope * share[1], slope * share[2]}, {-w_dx, -w_dy, 1.0f}, residual};
  }
  __device__ RowShape edge(int side, float root_blur) const {
    const float factor = change[side] / root_blur * (side % 2 == 0 ? -1.0f : 1.0f);
    return {{factor * share[0], factor * share[1], factor * share[2]},
            {side < 2 ? 1.0f : 0.0f, side < 2 ? 0.0f : 1.0f, 0.0f},
            product[side] / change[side] * root_blur};
  }

 private:
  /// A pixel of a drawn point.
  struct Pixel {
    const PixelRowsJob& job;
    int point, number;

    __device__ float depth(int beside) const {
      return __ldcg(job.depth + std::int64_t{point} * job.pixels + number + beside);
    }
    /// Returns the residual and slope of a term.
    __device__ float2 term(int t, int beside = 0) const {
      const std::int64_t before = (std::int64_t{point} * job.terms + t) * job.pixels;
      return __ldcg(reinterpret_cast<const float2*>(job.slopes + before + number + beside));
    }
  };

  __device__ void join_terms(const Pixel& p) {
    float square = 0, sum = 0;
    for (int t = 0; t < p.job.terms; ++t) {
      const float2 term = p.term(t);
      square = fmaf(term.y, term.y, square);
      sum = fmaf(term.y, term.x, sum);
    }
    slope = sqrtf(square);
    residual = slope > 0 ? sum / slope : 0.0f;
  }
  __device__ void find_edge(const Pixel& p, int side, int beside, float w) {
    const float behind = p.depth(beside);
    if (w - behind <= kStep * w * behind) return;
    float square = 0, sum = 0;
    for (int t = 0; t < p.job.terms; ++t) {
      const float here = p.term(t).x, there = p.term(t, beside).x, by = here - there;
      square = fmaf(by, by, square);
      sum = fmaf(by, 0.5f * (here + there), sum);
    }
    change[side] = sqrtf(square);
    product[side] = sum;
  }
};

/// Sums the products of two groups of kRowSide columns over rows that a warp makes one by one. Lane
/// i has column i of the first group.
class RowSums {
 public:
  __device__ RowSums(const SceneLayout& scene, const PixelRowsJob& job, int point, int first,
                     int second)
      : scene_(scene),
        job_(job),
        point_(point),
        lane_(static_cast<int>(threadIdx.x) % kWarp),
        column_(kRowSide * first + lane_),
        other_(kRowSide * second + lane_),
        same_(first == second) {
    own_step_ = step(column_);
    other_step_ = step(other_);
  }

  /// Adds the rows of the lanes where `there` holds.
  template <class Shape>
  __device__ void add(const PixelRowShapes& pixel, bool there, const Shape& shape_of) {
    unsigned left = __ballot_sync(kWholeWarp, there);
    if (left == 0) return;
    const RowShape own = there ? shape_of() : RowShape{};
    while (left != 0) {
      const int from = __ffs(static_cast<int>(left)) - 1;
      left &= left - 1;
      const auto get = [&](auto value) { return __shfl_sync(kWholeWarp, value, from); };
      const RowShape row{{get(own.share[0]), get(own.share[1]), get(own.share[2])},
                         {get(own.along.x), get(own.along.y), get(own.along.z)},
                         get(own.residual)};
      const int corner[3] = {get(pixel.corner[0]), get(pixel.corner[1]), get(pixel.corner[2])};
      add_row(row, corner, Records(job_, scene_, point_, get(pixel.view)));
    }
  }

  /// Returns the sum of column lane x column i of the second group.
  __device__ float sum(int i) const { return sums_[i]; }

 private:
  __device__ float step(int column) const {
    if (column >= job_.columns) return 0.0f;
    return __ldcg(job_.per_step + std::int64_t{point_} * job_.columns + column);
  }

  __device__ void add_row(const RowShape& row, const int (&corner)[3], const Records& records) {
    const float own = value(row, corner, records, column_, own_step_);
    const float other = same_ ? own : value(row, corner, records, other_, other_step_);
    if (!__any_sync(kWholeWarp, own != 0.0f)) return;
#pragma unroll
    for (int i = 0; i < kRowSide; ++i) {
      sums_[i] = fmaf(own, __shfl_sync(kWholeWarp, other, i), sums_[i]);
    }
  }

  /// Returns a column's number in a row.
  __device__ float value(const RowShape& row, const int (&corner)[3], const Records& records,
                         int column, float per_step) const {
    if (column >= job_.columns) return column == job_.columns ? row.residual : 0.0f;
    float sum = 0;
#pragma unroll
    for (int k = 0; k < 3; ++k) {
      const float3 here = records(corner[k], 0), there = records(corner[k], column + 1);
      const float motion = row.along.x * (there.x - here.x) + row.along.y * (there.y - here.y) +
                           row.along.z * (there.z - here.z);
      if (there.z > 0.0f) sum = fmaf(row.share[k], motion, sum);
    }
    return sum * per_step;
  }

  const SceneLayout& scene_;
  const PixelRowsJob& job_;
  int point_, lane_, column_, other_;
  bool same_;
  float own_step_, other_step_;
  float sums_[kRowSide] = {};
};

/// Sums the rows of all pixels: blocks in x share the pixels, those in y are squares of columns,
/// those in z are points.
/// The pixels of a warp are spread over the picture, so that all warps have about as many rows.
__global__ void __launch_bounds__(kRowThreads)
    add_rows(const __grid_constant__ SceneLayout scene, const __grid_constant__ PixelRowsJob job) {
  wait_for_previous();
  let_next_start();
  const int sides = (job.columns + kRowSide) / kRowSide;
  int first = 0, second = static_cast<int>(blockIdx.y);
  for (; second >= sides - first; ++first) second -= sides - first;
  second += first;
  const int point = static_cast<int>(blockIdx.z);
  if (rests(job, point)) return;
  RowSums sums(scene, job, point, first, second);
  const float root_blur = sqrtf(__ldcg(job.blurs + point));
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  const int warp = static_cast<int>(threadIdx.x) / kWarp;
  const int groups = (job.pixels + kPixelsPerWarp - 1) / kPixelsPerWarp;
  const int step = static_cast<int>(gridDim.x) * kRowWarps;
  for (int group = static_cast<int>(blockIdx.x) * kRowWarps + warp; group < groups; group += step) {
    const PixelRowShapes pixel(scene, job, point,
                               lane < kPixelsPerWarp ? lane * groups + group : job.pixels);
    sums.add(pixel, pixel.slope != 0.0f, [&] { return pixel.surface(); });
#pragma unroll
    for (int side = 0; side < PixelRowShapes::kSides; ++side) {
      sums.add(pixel, pixel.change[side] != 0.0f, [&] { return pixel.edge(side, root_blur); });
    }
  }
  __shared__ float of_warp[kRowWarps][kRowSquare];
#pragma unroll
  for (int i = 0; i < kRowSide; ++i) of_warp[warp][kRowSide * i + lane] = sums.sum(i);
  __syncthreads();
  const std::int64_t square = std::int64_t{point} * gridDim.y + blockIdx.y;
  float* const parts = job.parts + (square * gridDim.x + blockIdx.x) * kRowSquare;
  const int last = job.columns - kRowSide * second, last_row = job.columns - kRowSide * first;
  for (int i = static_cast<int>(threadIdx.x); i < kRowSquare; i += kRowThreads) {
    if (i / kRowSide > last || i % kRowSide > last_row) continue;  // no such columns
    float sum = 0;
    for (int w = 0; w < kRowWarps; ++w) sum += of_warp[w][i];
    parts[i] = sum;
  }
}

/// Adds up the parts of all numbers: a block for one column of a square, one number per lane.
__global__ void __launch_bounds__(kJoinWarps* kWarp)
    join_rows(const __grid_constant__ PixelRowsJob job, int blocks) {
  wait_for_previous();
  let_next_start();
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  const int warp = static_cast<int>(threadIdx.x) / kWarp;
  const std::int64_t square = blockIdx.x / kRowSide;
  const int sides = (job.columns + kRowSide) / kRowSide;
  if (rests(job, static_cast<int>(square / (sides * (sides + 1) / 2)))) return;
  const int number = static_cast<int>(blockIdx.x % kRowSide) * kRowSide + lane;
  const float* parts = job.parts + square * blocks * kRowSquare + number;
  double sum = 0;
  for (int b = warp; b < blocks; b += kJoinWarps) {
    sum += __ldcg(parts + std::int64_t{b} * kRowSquare);
  }
  __shared__ double of_warp[kJoinWarps][kWarp];
  of_warp[warp][lane] = sum;
  __syncthreads();
  if (warp > 0) return;
  for (int w = 1; w < kJoinWarps; ++w) sum += of_warp[w][lane];
  job.sums[square * kRowSquare + number] = sum;
}

}  // namespace

std::int64_t row_blocks(std::int64_t pixels, std::int64_t points) {
  const std::int64_t groups = (pixels + kPixelsPerWarp - 1) / kPixelsPerWarp;
  const std::int64_t most =
      std::clamp<std::int64_t>(kAllRowBlocks / points, kLeastRowBlocks, kMostRowBlocks);
  return std::clamp<std::int64_t>((groups + kRowWarps - 1) / kRowWarps, 1, most);
}

std::int64_t record_floats(const SceneLayout& scene, int sets, int columns) {
  return std::int64_t{4} * sets * scene.vertex_count * (columns + 1);
}

void enqueue_posing(const SceneLayout& scene, const DeviceLimits& limits, const PixelRowsJob& job,
                    Stream stream) {
  int end = 0;
  const PoseMemory at = detail::lay_out_pose(scene, end);
  const std::size_t bytes = sizeof(float) * static_cast<std::size_t>(end);
  if (bytes > most_shared_bytes(limits))
    throw DeviceError(
        "CUDA: this scene's bones do not fit into the device's shared memory; use fewer or simpler "
        "models, or backend: cpu");
  allow_shared_memory(&place_states, limits);
  const auto points = static_cast<unsigned>(job.points);
  launch(&place_states, dim3(static_cast<unsigned>(job.columns + 1), points), dim3(kPoseThreads),
         bytes, stream, overlaps_launches(limits), scene, job, at);
}

void enqueue_owners(const SceneLayout& scene, const DeviceLimits& limits, const PixelRowsJob& job,
                    Stream stream) {
  const std::int64_t threads = std::int64_t{scene.triangle_count} * job.view_count * kWarp;
  launch(&find_owners,
         dim3(static_cast<unsigned>((threads + kTriangleThreads - 1) / kTriangleThreads),
              static_cast<unsigned>(job.points)),
         dim3(kTriangleThreads), 0, stream, overlaps_launches(limits), scene, job);
}

void enqueue_pixel_rows(const SceneLayout& scene, const DeviceLimits& limits,
                        const PixelRowsJob& job, Stream stream) {
  const bool overlap = overlaps_launches(limits);
  const auto points = static_cast<unsigned>(job.points);
  const auto blocks = static_cast<unsigned>(row_blocks(job.pixels, job.points));
  launch(&add_rows, dim3(blocks, static_cast<unsigned>(row_squares(job.columns)), points),
         dim3(kRowThreads), 0, stream, overlap, scene, job);
  const auto columns = static_cast<unsigned>(job.points * row_squares(job.columns) * kRowSide);
  launch(&join_rows, dim3(columns), dim3(kJoinWarps * kWarp), 0, stream, overlap, job,
         static_cast<int>(blocks));
}

}  // namespace hypotrack::cuda::internal
