// Included once per instruction set: no #pragma once.
#if defined(STEREO_PATCH_PATCH_COMPARE_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef STEREO_PATCH_PATCH_COMPARE_INL_HPP_
#undef STEREO_PATCH_PATCH_COMPARE_INL_HPP_
#else
#define STEREO_PATCH_PATCH_COMPARE_INL_HPP_
#endif

#include <cstddef>
#include <vector>

#include "hypotrack/plugin/simd-inl.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "patch_similarity-inl.hpp"

/// Comparisons of the patch around a pixel of the first view with that of the same pixel of the
/// second view, warped by a plane. Both planes of grey have the same size, NaN outside.
HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_patch::HWY_NAMESPACE {

using namespace hypotrack::HWY_NAMESPACE;  // Lanes

/// Sums over the columns of a band of rows, for sums over neighbouring columns.
class ColumnSums {
 public:
  explicit ColumnSums(int width) : sums_(static_cast<std::size_t>(width) + 2 * kLanes) {}
  HYPOTRACK_PIXEL void set(int x, Lanes value) {
    hn::StoreU(value.v, FloatTag(), sums_.data() + x);
  }
  /// Returns the sum over the columns x - radius .. x + radius.
  HYPOTRACK_PIXEL Lanes around(int x, int radius) const {
    const float* from = sums_.data() + x - radius;
    Lanes sum = load(from);
    for (int i = 1; i <= 2 * radius; ++i) sum = sum + load(from + i);
    return sum;
  }

 private:
  std::vector<float> sums_;
};

/// Zero-mean normalised cross-correlation. Sums over a patch are sums over its columns, which
/// neighbours share. They are recomputed for every row, because a running sum would never lose a
/// NaN.
class ZnccComparer {
 public:
  ZnccComparer(const PixelPlane<float>& left, int radius, float floor)
      : left_(left),
        radius_(radius),
        floor_(floor),
        mean_(left.width(), left.height()),
        variance_(left.width(), left.height()),
        b_(left.width()),
        bb_(left.width()),
        ab_(left.width()) {
    measure_left();
  }

  HYPOTRACK_PIXEL void start_row(const PixelPlane<float>& right, int y) {
    for (int x = 0; x < left_.width(); x += kLanes) {
      Lanes b(0.0f), bb(0.0f), ab(0.0f);
      for (int j = -radius_; j <= radius_; ++j) {
        const Lanes here = load(left_.row(y + j) + x), there = load(right.row(y + j) + x);
        b = b + there;
        bb = mul_add(there, there, bb);
        ab = mul_add(here, there, ab);
      }
      b_.set(x, b);
      bb_.set(x, bb);
      ab_.set(x, ab);
    }
  }

  HYPOTRACK_PIXEL Lanes correlation_at(const PixelPlane<float>&, int x, int y) const {
    const Lanes share(pixel_share());
    const Moments<Lanes> a{load(mean_.row(y) + x), load(variance_.row(y) + x)};
    const auto b =
        moments(b_.around(x, radius_) * share, bb_.around(x, radius_) * share, Lanes(floor_));
    return correlation(ab_.around(x, radius_) * share, a, b);
  }

 private:
  float pixel_share() const {
    const auto side = static_cast<float>(2 * radius_ + 1);
    return 1.0f / (side * side);
  }

  void measure_left() {
    const Lanes share(pixel_share());
    for (int y = radius_; y < left_.height() - radius_; ++y) {
      start_row(left_, y);
      for (int x = radius_; x < left_.width() - radius_; x += kLanes) {
        const auto a =
            moments(b_.around(x, radius_) * share, bb_.around(x, radius_) * share, Lanes(floor_));
        hn::StoreU(a.mean.v, FloatTag(), mean_.row(y) + x);
        hn::StoreU(a.variance.v, FloatTag(), variance_.row(y) + x);
      }
    }
  }

  const PixelPlane<float>& left_;
  int radius_;
  float floor_;
  PixelPlane<float> mean_, variance_;  ///< of the first view's patches
  ColumnSums b_, bb_, ab_;
};

/// Census: z = 1 - 2 d. d is the share of a patch's pixels that are darker than its centre in only
/// one view (R. Zabih, J. Woodfill, "Non-parametric local transforms for computing visual
/// correspondence", ECCV 1994: the Hamming distance of their census transforms).
class CensusComparer {
 public:
  CensusComparer(const PixelPlane<float>& left, int radius) : left_(left), radius_(radius) {}

  HYPOTRACK_PIXEL void start_row(const PixelPlane<float>&, int) {}

  HYPOTRACK_PIXEL Lanes correlation_at(const PixelPlane<float>& right, int x, int y) const {
    const Lanes zero(0.0f), one(1.0f);
    const Lanes a = load(left_.row(y) + x), b = load(right.row(y) + x);
    Lanes different(0.0f), nothing(0.0f);
    for (int j = -radius_; j <= radius_; ++j) {
      for (int i = -radius_; i <= radius_; ++i) {
        const Lanes here = load(left_.row(y + j) + x + i), there = load(right.row(y + j) + x + i);
        const Lanes darker_here = select(here < a, one, zero);
        different = different + abs(darker_here - select(there < b, one, zero));
        nothing = mul_add(here + there, zero, nothing);  // stays 0, or becomes NaN
      }
    }
    const auto side = static_cast<float>(2 * radius_ + 1);
    return mul_add(different, Lanes(-2.0f / (side * side - 1.0f)), one) + nothing;
  }

 private:
  const PixelPlane<float>& left_;
  int radius_;
};

}  // namespace hypotrack::stereo_patch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
