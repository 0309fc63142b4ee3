#include "cuda/fill_job.hpp"
#include "cuda/patches.cuh"
#include "hypotrack/gpu/runtime.cuh"
#include "patch_similarity-inl.hpp"

namespace hypotrack::stereo_patch {
namespace {

// Pixels of a block, one per thread; all of one plane.
constexpr int kWidth = 32;
constexpr int kHeight = 8;
constexpr int kThreads = kWidth * kHeight;

/// Neighbourhood of the block's pixels in shared memory. Holds both views, extended by `radius`
/// pixels, then sums over columns of 2 radius + 1 pixels, a row of them for each row of the block.
struct Surroundings {
  int radius, pitch, rows;
  float* here;
  float* there;
  float* sums;  ///< a, aa, b, bb, ab

  static constexpr int kSums = 5;
  static __host__ __device__ int pitch_of(int radius) { return kWidth + 2 * radius; }
  static __host__ __device__ int rows_of(int radius) { return kHeight + 2 * radius; }
  static int floats(int radius) {
    return pitch_of(radius) * (2 * rows_of(radius) + kSums * kHeight);
  }

  __device__ Surroundings(int r, float* memory)
      : radius(r),
        pitch(pitch_of(r)),
        rows(rows_of(r)),
        here(memory),
        there(here + pitch * rows),
        sums(there + pitch * rows) {}

  __device__ float& sum(int which, int x, int y) const {
    return sums[(which * kHeight + y) * pitch + x];
  }
};

__device__ void load(const FillJob& job, float w, int x0, int y0, const Surroundings& s) {
  for (int i = static_cast<int>(threadIdx.x); i < s.pitch * s.rows; i += kThreads) {
    const int x = x0 - s.radius + i % s.pitch, y = y0 - s.radius + i / s.pitch;
    s.here[i] = grey_at(job.left, x, y);
    s.there[i] = warped_at(job, w, x, y);
  }
}

__device__ void sum_columns(const Surroundings& s) {
  for (int i = static_cast<int>(threadIdx.x); i < s.pitch * kHeight; i += kThreads) {
    const int x = i % s.pitch, y = i / s.pitch;
    float a = 0, aa = 0, b = 0, bb = 0, ab = 0;
    for (int j = 0; j <= 2 * s.radius; ++j) {
      const float here = s.here[(y + j) * s.pitch + x], there = s.there[(y + j) * s.pitch + x];
      a += here;
      aa = __fmaf_rn(here, here, aa);
      b += there;
      bb = __fmaf_rn(there, there, bb);
      ab = __fmaf_rn(here, there, ab);
    }
    s.sum(0, x, y) = a;
    s.sum(1, x, y) = aa;
    s.sum(2, x, y) = b;
    s.sum(3, x, y) = bb;
    s.sum(4, x, y) = ab;
  }
}

/// Computes z of the block's pixel (x, y) by cross-correlation.
__device__ float zncc(const Surroundings& s, float floor, int x, int y) {
  const auto side = static_cast<float>(2 * s.radius + 1);
  const float share = 1.0f / (side * side);
  float mean[Surroundings::kSums];
  for (int k = 0; k < Surroundings::kSums; ++k) {
    float sum = s.sum(k, x, y);
    for (int i = 1; i <= 2 * s.radius; ++i) sum += s.sum(k, x + i, y);
    mean[k] = sum * share;
  }
  return scalar::correlation(mean[4], scalar::moments(mean[0], mean[1], floor),
                             scalar::moments(mean[2], mean[3], floor));
}

/// Computes z of the block's pixel (x, y) by census (patch_compare-inl.hpp).
__device__ float census(const Surroundings& s, int x, int y) {
  const int middle = (y + s.radius) * s.pitch + x + s.radius;
  const float a = s.here[middle], b = s.there[middle];
  int different = 0;
  float nothing = 0;
  for (int j = 0; j <= 2 * s.radius; ++j) {
    for (int i = 0; i <= 2 * s.radius; ++i) {
      const float here = s.here[(y + j) * s.pitch + x + i];
      const float there = s.there[(y + j) * s.pitch + x + i];
      different += (here < a) != (there < b);
      nothing = __fmaf_rn(here + there, 0.0f, nothing);  // stays 0, or becomes NaN
    }
  }
  const auto side = static_cast<float>(2 * s.radius + 1);
  return __fmaf_rn(static_cast<float>(different), -2.0f / (side * side - 1.0f), 1.0f) + nothing;
}

/// Writes a similarity into the volume. A row of a plane lies `width` words behind that of the
/// plane before. A word's low half is the similarity at its plane, the high half that at the next.
__device__ void write(const FillJob& job, int plane, int x, int y, float s) {
  const auto value = static_cast<std::uint16_t>(__float2uint_rn(s * 65535.0f));
  const int width = job.left.width;
  std::uint16_t* word = job.similarities + 2 * ((y * job.planes.count + plane) * width + x);
  word[0] = value;
  if (plane > 0) word[1 - 2 * width] = value;
  if (plane + 1 == job.planes.count) word[1] = 0;
}

__global__ void __launch_bounds__(kThreads) fill(const __grid_constant__ FillJob job) {
  const auto plane = static_cast<int>(blockIdx.z);
  const int x0 = static_cast<int>(blockIdx.x) * kWidth, y0 = static_cast<int>(blockIdx.y) * kHeight;
  const Surroundings s(job.radius, cuda::shared_floats());
  load(job, job.planes.first + static_cast<float>(plane) * job.planes.step, x0, y0, s);
  __syncthreads();
  if (job.measure == Measure::zncc) {
    sum_columns(s);
    __syncthreads();
  }
  const int dx = static_cast<int>(threadIdx.x) % kWidth;
  const int dy = static_cast<int>(threadIdx.x) / kWidth;
  const int x = x0 + dx, y = y0 + dy;
  if (threadIdx.x == 0 && x0 == 0 && y0 == 0 && plane == 0) *job.known_planes = job.planes;
  if (x >= job.left.width || y >= job.left.height) return;
  const float z =
      job.measure == Measure::zncc ? zncc(s, job.variance_floor, dx, dy) : census(s, dx, dy);
  const bool counts =
      !job.masked || job.left.pixels[y * job.left.width + x] & cuda::kForegroundFlag;
  write(job, plane, x, y, counts ? scalar::similarity(z, job.sharpness) : 0.0f);
}

}  // namespace

void enqueue_fill(const FillJob& job, cuda::Stream stream) {
  const auto blocks = [](int pixels, int each) {
    return static_cast<unsigned>((pixels + each - 1) / each);
  };
  const dim3 grid(blocks(job.left.width, kWidth), blocks(job.left.height, kHeight),
                  static_cast<unsigned>(job.planes.count));
  const auto bytes = sizeof(float) * static_cast<std::size_t>(Surroundings::floats(job.radius));
  cuda::launch(&fill, grid, dim3(kThreads), bytes, stream, false, job);
}

}  // namespace hypotrack::stereo_patch
