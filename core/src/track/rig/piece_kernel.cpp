// Compiled once per instruction set: the include below includes this file again.

#define HWY_TARGET_INCLUDE "track/rig/piece_kernel.cpp"
#include "track/rig/piece_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <hypotrack/plugin/foreach_target-inl.hpp>
#include <numeric>
#include <vector>

#include "hypotrack/plugin/simd-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {
namespace {

constexpr int kSide = internal::kPieceSide;
constexpr float kPixels = kSide * kSide;

/// Levels of kSide rows, and sums over their columns.
class Lines {
 public:
  HWY_ATTR Lines(const std::uint8_t* pixels, std::ptrdiff_t stride, int width)
      : stride_((width + kSide + 2 * kLanes) / kLanes * kLanes),
        all_(static_cast<std::size_t>((kSide + 2) * stride_)) {
    for (int y = 0; y < kSide; ++y) read(pixels + y * stride, width, all_.data() + y * stride_);
    for (int x = 0; x < width; x += kLanes) {
      Lanes sum = 0, square = 0;
      for (int y = 0; y < kSide; ++y) {
        const Lanes level = load(row(y) + x);
        sum = sum + level;
        square = mul_add(level, level, square);
      }
      store(sum, kLanes, all_.data() + kSide * stride_ + x);
      store(square, kLanes, all_.data() + (kSide + 1) * stride_ + x);
    }
  }
  const float* row(int y) const { return all_.data() + y * stride_; }
  const float* sums() const { return row(kSide); }
  const float* squares() const { return row(kSide + 1); }

 private:
  HWY_ATTR static void read(const std::uint8_t* pixels, int width, float* out) {
    constexpr int kMiddle = 128;  // sums of squares are exact in a float then
    const hn::Rebind<std::uint8_t, IntTag> bytes;
    int x = 0;
    for (; x + kLanes <= width; x += kLanes) {
      const auto levels = hn::PromoteTo(IntTag(), hn::LoadU(bytes, pixels + x));
      store(to_float({hn::Sub(levels, hn::Set(IntTag(), kMiddle))}), kLanes, out + x);
    }
    for (; x < width; ++x) out[x] = static_cast<float>(pixels[x] - kMiddle);
  }

  std::ptrdiff_t stride_;
  std::vector<float> all_;
};

/// Correlates a piece with the kLanes pieces from column x on, given its products with them.
HWY_ATTR Lanes correlation(const internal::Piece& piece, const Lines& lines, int x,
                           Lanes products) {
  Lanes sum = 0, square = 0;
  for (int i = 0; i < kSide; ++i) {
    sum = sum + load(lines.sums() + x + i);
    square = square + load(lines.squares() + x + i);
  }
  const Lanes variance = square - sum * sum * Lanes(1 / kPixels);
  return (products - sum * Lanes(piece.mean)) / (sqrt(max(variance, kPixels)) * Lanes(piece.norm));
}

HWY_ATTR void correlate(const internal::Piece& piece, const std::uint8_t* pixels,
                        std::ptrdiff_t stride, std::span<float> likeness) {
  const auto places = static_cast<int>(likeness.size());
  const Lines lines(pixels, stride, places + kSide - 1);
  for (int x = 0; x < places; x += 2 * kLanes) {
    Lanes left = 0, right = 0;  // two sums hide the latency of an addition
    const float* level = piece.levels.data();
    for (int y = 0; y < kSide; ++y) {
      const float* row = lines.row(y) + x;
      for (int i = 0; i < kSide; ++i, ++level) {
        left = mul_add(*level, load(row + i), left);
        right = mul_add(*level, load(row + i + kLanes), right);
      }
    }
    float* out = likeness.data() + x;
    store(correlation(piece, lines, x, left), std::min(kLanes, places - x), out);
    if (const int rest = places - x - kLanes; rest > 0)
      store(correlation(piece, lines, x + kLanes, right), std::min(kLanes, rest), out + kLanes);
  }
}

HWY_ATTR void sum_changes(const std::uint8_t* a, const std::uint8_t* b, std::ptrdiff_t stride,
                          std::span<std::uint16_t> sums) {
  const hn::ScalableTag<std::uint16_t> words;
  const hn::Rebind<std::uint8_t, decltype(words)> bytes;
  const auto lanes = static_cast<int>(hn::Lanes(words)), width = static_cast<int>(sums.size());
  int x = 0;
  for (; x + lanes <= width; x += lanes) {
    auto sum = hn::Zero(words);
    for (int y = 0; y < kSide; ++y) {
      const auto from = [&](const std::uint8_t* pixels)
                            HWY_ATTR { return hn::LoadU(bytes, pixels + y * stride + x); };
      const auto [one, other] = std::pair(from(a), from(b));
      const auto apart = hn::Sub(hn::Max(one, other), hn::Min(one, other));
      sum = hn::Add(sum, hn::PromoteTo(words, apart));
    }
    hn::StoreU(sum, words, sums.data() + x);
  }
  for (; x < width; ++x) {
    int sum = 0;
    for (int y = 0; y < kSide; ++y) sum += std::abs(a[y * stride + x] - b[y * stride + x]);
    sums[static_cast<std::size_t>(x)] = static_cast<std::uint16_t>(sum);
  }
}

}  // namespace
}  // namespace hypotrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::internal {
namespace {
HWY_EXPORT(correlate);
HWY_EXPORT(sum_changes);
}  // namespace

Piece::Piece(const std::uint8_t* pixels, std::ptrdiff_t stride) {
  constexpr float kPixels = kPieceSide * kPieceSide;
  for (int y = 0; y < kPieceSide; ++y)
    std::copy_n(pixels + y * stride, kPieceSide, levels.begin() + y * kPieceSide);
  const float middle = std::round(std::accumulate(levels.begin(), levels.end(), 0.0F) / kPixels);
  for (float& level : levels) level -= middle;
  mean = std::accumulate(levels.begin(), levels.end(), 0.0F) / kPixels;
  const float squares = std::inner_product(levels.begin(), levels.end(), levels.begin(), 0.0F);
  norm = std::sqrt(std::max(squares - kPixels * mean * mean, kPixels));
}

void correlate(const Piece& piece, const std::uint8_t* pixels, std::ptrdiff_t stride,
               std::span<float> likeness) {
  HWY_DYNAMIC_DISPATCH(correlate)(piece, pixels, stride, likeness);
}

void sum_changes(const std::uint8_t* a, const std::uint8_t* b, std::ptrdiff_t stride,
                 std::span<std::uint16_t> sums) {
  HWY_DYNAMIC_DISPATCH(sum_changes)(a, b, stride, sums);
}

}  // namespace hypotrack::internal
#endif
