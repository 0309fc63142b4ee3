// Included once per instruction set: no #pragma once.
#if defined(STEREO_PATCH_RECTIFIED_VOLUME_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef STEREO_PATCH_RECTIFIED_VOLUME_INL_HPP_
#undef STEREO_PATCH_RECTIFIED_VOLUME_INL_HPP_
#else
#define STEREO_PATCH_RECTIFIED_VOLUME_INL_HPP_
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "hypotrack/simd-inl.hpp"
#include "patch_similarity-inl.hpp"
#include "volume_kernel.hpp"

/// The volume of a rectified pair by zero-mean normalised cross-correlation. A plane shifts the
/// second view by whole pixels and a fraction, so a patch's sums are blends of sums over patches
/// that are whole pixels apart. All planes share the sums of the second view's grey, and planes of
/// the same whole pixels those of products of both views.
HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_patch::HWY_NAMESPACE {

using namespace hypotrack::HWY_NAMESPACE;  // Lanes

/// Returns 1 / sqrt(x), to about a millionth.
HYPOTRACK_PIXEL Lanes inverse_sqrt(Lanes x) {
  const Lanes guess(hn::ApproximateReciprocalSqrt(x.v));
  return guess * (Lanes(1.5f) - Lanes(0.5f) * x * guess * guess);
}

/// Fills the volume row by row.
class RectifiedFiller {
 public:
  RectifiedFiller(const VolumeJob& job, const Settings& settings, Volume& volume)
      : job_(job),
        settings_(settings),
        volume_(volume),
        width_(volume.width),
        radius_(settings.radius),
        share_(1.0f / static_cast<float>((2 * radius_ + 1) * (2 * radius_ + 1))) {
    const int a = shift_of(0).from, b = shift_of(volume.planes.count - 1).from;
    first_ = std::min(a, b);
    seen_ = std::max(a, b) - first_ + 1 + width_;
    const auto row = [](int columns) {
      return std::vector<float>(static_cast<std::size_t>(columns) + 3 * kLanes);
    };
    columns_ = row(seen_);
    for (auto* sums : {&left_mean_, &left_scale_}) *sums = row(width_);
    for (Products& products : products_) products.sums = row(width_);
    for (auto* sums : {&grey_, &squares_, &neighbours_}) *sums = row(seen_);
    similarities_ = std::vector<std::uint32_t>(static_cast<std::size_t>(width_) + 3 * kLanes);
  }

  void fill_row(int y) {
    std::uint32_t* out = volume_.words.data() + static_cast<std::size_t>(y) * volume_.row_stride();
    if (y < radius_ || y >= volume_.height - radius_ || width_ <= 2 * radius_) {
      std::fill_n(out, volume_.row_stride(), 0u);
      return;
    }
    measure_left(y);
    measure_right(y);
    for (Products& products : products_) products.from = kNone;
    for (int plane = volume_.planes.count - 1; plane >= 0; --plane)
      fill_plane(y, plane, out + static_cast<std::ptrdiff_t>(plane) * width_);
  }

 private:
  static constexpr int kNone = -1;

  /// Where a plane shows the first view's column 0 in a row of the second, and the fraction of a
  /// pixel that it is beyond.
  struct Shift {
    int from;
    float fraction;
  };

  /// Sums of products of the first view with the second, shifted by whole pixels.
  struct Products {
    int from = kNone;
    std::vector<float> sums;
  };

  Shift shift_of(int plane) const {
    const float w = volume_.planes.first + static_cast<float>(plane) * volume_.planes.step;
    const float offset = job_.map.a[0][2] + job_.map.b[0] * w;
    const float whole = std::floor(offset);
    const auto margin = static_cast<float>(job_.margin);
    // Beyond the image there are only the margins' NaNs.
    const int shift = static_cast<int>(std::min(std::max(whole, -margin), margin - 1));
    return {job_.margin + shift, offset - whole};
  }

  /// Sums over patches of `columns` columns. `value(row, x)` returns kLanes values from column x of
  /// a row.
  template <class Value>
  HYPOTRACK_PIXEL void sum_patches(int y, int columns, Value value, float* out) {
    for (int x = 0; x < columns; x += kLanes) {
      Lanes sum(0.0f);
      for (int j = y - radius_; j <= y + radius_; ++j) sum = value(j, x, sum);
      hn::StoreU(sum.v, FloatTag(), columns_.data() + x);
    }
    for (int x = radius_; x < columns - radius_; x += kLanes) {
      const float* from = columns_.data() + x - radius_;
      Lanes sum = load(from);
      for (int i = 1; i <= 2 * radius_; ++i) sum = sum + load(from + i);
      hn::StoreU((sum * Lanes(share_)).v, FloatTag(), out + x);
    }
  }

  void measure_left(int y) {
    const auto& left = job_.left;
    const auto grey = [&](int j, int x, Lanes sum) HWY_ATTR { return sum + load(left.row(j) + x); };
    const auto square = [&](int j, int x, Lanes sum) HWY_ATTR {
      const Lanes a = load(left.row(j) + x);
      return mul_add(a, a, sum);
    };
    sum_patches(y, width_, grey, left_mean_.data());
    sum_patches(y, width_, square, left_scale_.data());
    const Lanes floor(static_cast<float>(settings_.variance_floor));
    for (int x = radius_; x < width_ - radius_; x += kLanes) {
      const auto a = moments(load(left_mean_.data() + x), load(left_scale_.data() + x), floor);
      hn::StoreU(inverse_sqrt(a.variance).v, FloatTag(), left_scale_.data() + x);
    }
  }

  void measure_right(int y) {
    const auto at = [&](int j, int x) HWY_ATTR { return job_.right.row(j) + first_ + x; };
    const auto grey = [&](int j, int x, Lanes sum) HWY_ATTR { return sum + load(at(j, x)); };
    const auto square = [&](int j, int x, Lanes sum) HWY_ATTR {
      const Lanes b = load(at(j, x));
      return mul_add(b, b, sum);
    };
    const auto neighbours = [&](int j, int x, Lanes sum) HWY_ATTR {
      return mul_add(load(at(j, x)), load(at(j, x) + 1), sum);
    };
    sum_patches(y, seen_, grey, grey_.data());
    sum_patches(y, seen_, square, squares_.data());
    sum_patches(y, seen_, neighbours, neighbours_.data());
  }

  const float* products(int y, int from) {
    Products& out = products_[static_cast<std::size_t>(from % 2)];
    if (out.from != from) {
      out.from = from;
      const auto product = [&](int j, int x, Lanes sum) HWY_ATTR {
        return mul_add(load(job_.left.row(j) + x), load(job_.right.row(j) + from + x), sum);
      };
      sum_patches(y, width_, product, out.sums.data());
    }
    return out.sums.data();
  }

  /// Writes the similarities at a plane, with those of the next one, which was filled before.
  void fill_plane(int y, int plane, std::uint32_t* out) {
    const auto [from, fraction] = shift_of(plane);
    const float* here = products(y, from);
    const float* beyond = products(y, from + 1);
    const std::ptrdiff_t column = from - first_;
    const Lanes b(fraction), a = Lanes(1.0f) - b, aa = a * a, ab = Lanes(2.0f) * a * b, bb = b * b;
    const Lanes sharpness(static_cast<float>(settings_.sharpness));
    const Lanes floor(static_cast<float>(settings_.variance_floor));
    const UintTag tag;
    const bool is_last = plane + 1 == volume_.planes.count;
    for (int x = radius_; x < width_ - radius_; x += kLanes) {
      const std::ptrdiff_t at = column + x;
      const Lanes mean = mul_add(load(grey_.data() + at), a, load(grey_.data() + at + 1) * b);
      const Lanes square =
          mul_add(load(squares_.data() + at), aa,
                  mul_add(load(neighbours_.data() + at), ab, load(squares_.data() + at + 1) * bb));
      const Lanes product = mul_add(load(here + x), a, load(beyond + x) * b);
      const Lanes covariance = product - load(left_mean_.data() + x) * mean;
      const Lanes scale = inverse_sqrt(moments(mean, square, floor).variance);
      const Lanes z = covariance * load(left_scale_.data() + x) * scale;
      const Lanes s = similarity(z, sharpness) * load(volume_.weight.row(y) + x);
      const auto low = hn::BitCast(tag, to_int(s * Lanes(65535.0f)).v);
      const auto next = is_last ? hn::Zero(tag) : hn::LoadU(tag, similarities_.data() + x);
      hn::StoreU(low, tag, similarities_.data() + x);
      const auto mask = hn::RebindMask(tag, first_lanes(std::min(kLanes, width_ - radius_ - x)).m);
      hn::BlendedStore(hn::Or(low, hn::ShiftLeft<16>(next)), mask, tag, out + x);
    }
    std::fill_n(out, radius_, 0u);
    std::fill_n(out + width_ - radius_, radius_, 0u);
  }

  const VolumeJob& job_;
  const Settings& settings_;
  Volume& volume_;
  int width_, radius_;
  float share_;               ///< of a pixel in a patch
  int first_ = 0, seen_ = 0;  ///< columns of the second view that planes show
  std::vector<float> columns_;
  std::vector<float> left_mean_, left_scale_;       ///< 1 / standard deviation
  std::vector<float> grey_, squares_, neighbours_;  ///< means of the second view
  std::array<Products, 2> products_;                ///< of even and odd columns
  std::vector<std::uint32_t> similarities_;         ///< of the plane before
};

}  // namespace hypotrack::stereo_patch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
