#include "probe_terms.hpp"

#include "hypotrack/gpu/pixel_objective.cuh"

namespace hypotrack::test {
namespace {

using cuda::StereoPixel;
using cuda::ViewPixel;

struct CoveredTerm {
  static constexpr bool kStereo = false;
  static constexpr bool kVisitsUncovered = false;
  static constexpr int kSums = 1;
  __device__ int views() const { return -1; }
  __device__ void pixel(const ViewPixel& p, float (&sums)[kSums]) const {
    sums[0] += 1.0f + static_cast<float>(p.x) * 0.002f + static_cast<float>(p.y) * 0.003f +
               p.inverse_depth * 0.25f;
  }
  __device__ double cost(const double (&sums)[kSums], const float*) const { return sums[0]; }
};

struct MarkTerm {
  static constexpr bool kStereo = false;
  static constexpr bool kVisitsUncovered = false;
  static constexpr int kSums = 2;
  __device__ int views() const { return -1; }
  __device__ void pixel(const ViewPixel& p, float (&sums)[kSums]) const {
    const PixelMark mark = mark_of_pixel(p.x, p.y, p.inverse_depth);
    sums[0] += static_cast<float>(mark.first);
    sums[1] += static_cast<float>(mark.second);
  }
  __device__ double cost(const double (&sums)[kSums], const float*) const {
    return sums[0] + kSecondMark * sums[1];
  }
};

template <bool kUncovered>
struct SeenTerm {
  static constexpr bool kStereo = true;
  static constexpr bool kVisitsUncovered = kUncovered;
  static constexpr int kSums = 2;
  float tolerance;
  __device__ int directions() const { return 3; }
  template <int kReference>
  __device__ void pixel(const StereoPixel& p, float (&sums)[kSums]) const {
    if (p.seen) {
      sums[kReference] += 1.0f + p.u * 0.002f + static_cast<float>(p.column) * 0.001f +
                          static_cast<float>(p.row) * 0.0015f;
    }
    if (p.occluded) sums[kReference] += 0.5f;
    if (p.uncovered) sums[kReference] += 0.01f;
  }
  __device__ double cost(const double (&sums)[kSums], const float*) const {
    return sums[0] + sums[1];
  }
};

template <class Term>
class Probe final : public cuda::PixelObjective<Term> {
 public:
  explicit Probe(const Term& term) : term_(term) {}

 private:
  Term make_term(const cuda::DeviceObservation&, cuda::Stream) override { return term_; }
  Term term_;
};

constexpr int kEdgeThreads = 128;

/// One block per hypothesis.
template <bool kTexture>
__global__ void __launch_bounds__(kEdgeThreads)
    count_edges(const cuda::FrameLayout* frame, const __grid_constant__ cuda::BatchLayout batch,
                const __grid_constant__ cuda::DrawnBatch drawn) {
  __shared__ int sum;
  cuda::wait_for_previous();
  if (threadIdx.x == 0) sum = 0;
  __syncthreads();
  const int index = static_cast<int>(blockIdx.x);
  const cuda::DrawnTiles<kTexture> tiles{drawn, *frame, index};
  for (int v = 0; v < frame->view_count; ++v) {
    const auto depth = tiles(v);
    const int width = frame->views[v].width, height = frame->views[v].height;
    for (int i = static_cast<int>(threadIdx.x); i < width * height; i += kEdgeThreads) {
      const int x = i % width, y = i / width;
      if (x + 1 < width && (depth(x, y) > 0) != (depth(x + 1, y) > 0)) atomicAdd(&sum, 1);
    }
  }
  __syncthreads();
  if (threadIdx.x != 0) return;
  double& cost = batch.costs[drawn.first + index];
  cost = (batch.add ? cost : 0.0) + batch.weight * sum;
}

class EdgeProbe final : public cuda::DeviceObjective {
 public:
  bool draws() const override { return false; }
  void prepare(const cuda::DeviceObservation& observation, cuda::Stream) override {
    frame_ = observation.frame;
    ++revision_;
  }
  void reserve(const cuda::SceneLayout&, const cuda::DeviceLimits&, std::int64_t) override {}
  void enqueue_drawn(const cuda::SceneLayout&, const cuda::BatchLayout& batch,
                     const cuda::DrawnBatch& drawn, cuda::Stream stream) override {
    const dim3 grid(static_cast<unsigned>(drawn.count));
    auto* kernel = drawn.texture ? &count_edges<true> : &count_edges<false>;
    cuda::launch(kernel, grid, dim3(kEdgeThreads), 0, stream, false, frame_, batch, drawn);
  }
  std::uint64_t revision() const override { return revision_; }

 private:
  const cuda::FrameLayout* frame_ = nullptr;
  std::uint64_t revision_ = 0;
};

}  // namespace

std::unique_ptr<cuda::DeviceObjective> edge_probe_on_device() {
  return std::make_unique<EdgeProbe>();
}

std::unique_ptr<cuda::DeviceObjective> covered_probe_on_device() {
  return std::make_unique<Probe<CoveredTerm>>(CoveredTerm{});
}

std::unique_ptr<cuda::DeviceObjective> mark_probe_on_device() {
  return std::make_unique<Probe<MarkTerm>>(MarkTerm{});
}

std::unique_ptr<cuda::DeviceObjective> seen_probe_on_device(bool uncovered) {
  if (uncovered) return std::make_unique<Probe<SeenTerm<true>>>(SeenTerm<true>{kProbeTolerance});
  return std::make_unique<Probe<SeenTerm<false>>>(SeenTerm<false>{kProbeTolerance});
}

}  // namespace hypotrack::test
