#include "probe_terms.hpp"

#include "hypotrack/cuda/pixel_objective.cuh"

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

}  // namespace

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
