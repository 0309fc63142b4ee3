// Compiled once per instruction set: the include below includes this file again.

#define HWY_TARGET_INCLUDE "track/color/background_kernel.cpp"
#include <cstddef>
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "hypotrack/plugin/simd-inl.hpp"
#include "track/color/background_row.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {
namespace {

using Row = internal::BackgroundRow;

/// Learns from as many whole vectors of columns, from `x` on, as there are. Returns the next
/// column.
template <class Words>
HWY_INLINE int learn_from(Words words, int x, const std::uint8_t* picture,
                          const std::uint8_t* models, const Row& row) {
  constexpr std::int16_t kSame = 12 * Row::kOne;  // at most noise
  constexpr std::int16_t kAnewBelow = 60;         // steadiness
  constexpr std::int16_t kEighth = 1 << 12;       // of a frame in the mean, 1 << 15: all
  const hn::Rebind<std::uint8_t, Words> bytes;
  using Bytes = hn::Vec<decltype(bytes)>;
  using Vec = hn::Vec<Words>;
  const auto wide = [&](Bytes v) HWY_ATTR { return hn::PromoteTo(words, v); };
  const auto lanes = static_cast<int>(hn::Lanes(words));
  for (; x + lanes <= row.columns; x += lanes) {
    Bytes color[3];
    hn::LoadInterleaved3(bytes, picture + std::ptrdiff_t{3} * x, color[0], color[1], color[2]);
    const Vec zero = hn::Zero(words);
    const auto learns = hn::Eq(wide(hn::LoadU(bytes, models + x)), zero);
    Vec mean[3], apart[3], farthest = zero;
    for (int i = 0; i < 3; ++i) {
      mean[i] = hn::LoadU(words, row.means[i] + x);
      apart[i] = hn::Sub(hn::ShiftLeft<7>(wide(color[i])), mean[i]);
      farthest = hn::Max(farthest, hn::Abs(apart[i]));
    }
    const auto same = hn::Lt(farthest, hn::Set(words, kSame));
    const Vec before = wide(hn::LoadU(bytes, row.steady + x));
    const Vec agreed = hn::Add(hn::Sub(hn::ShiftLeft<3>(before), before),
                               hn::IfThenElse(same, hn::Set(words, 255 + 4), hn::Set(words, 4)));
    const Vec steady = hn::ShiftRight<3>(agreed);
    hn::StoreU(hn::DemoteTo(bytes, hn::IfThenElse(learns, steady, before)), bytes, row.steady + x);
    const auto anew = hn::AndNot(same, hn::Lt(steady, hn::Set(words, kAnewBelow)));
    for (int i = 0; i < 3; ++i) {
      const Vec part = hn::MulFixedPoint15(apart[i], hn::Set(words, kEighth));
      const Vec next = hn::Add(mean[i], hn::IfThenElse(anew, apart[i], part));
      hn::StoreU(hn::IfThenElse(learns, next, mean[i]), words, row.means[i] + x);
    }
  }
  return x;
}

void learn(const std::uint8_t* picture, const std::uint8_t* models, const Row& row) {
  const int rest = learn_from(hn::ScalableTag<std::int16_t>(), 0, picture, models, row);
  learn_from(hn::CappedTag<std::int16_t, 1>(), rest, picture, models, row);
}

template <class Words>
HWY_INLINE int write_from(Words words, int x, const Row& row, std::uint8_t* out) {
  const hn::Rebind<std::uint8_t, Words> bytes;
  const auto lanes = static_cast<int>(hn::Lanes(words));
  for (; x + lanes <= row.columns; x += lanes) {
    const auto channel = [&](int i) HWY_ATTR {
      const auto mean = hn::LoadU(words, row.means[i] + x);
      return hn::DemoteTo(
          bytes, hn::ShiftRight<7>(hn::Add(mean, hn::Set(words, std::int16_t{Row::kOne / 2}))));
    };
    const auto steady = hn::PromoteTo(words, hn::LoadU(bytes, row.steady + x));
    const auto known = hn::IfThenElseZero(hn::Gt(steady, hn::Set(words, Row::kKnown)),
                                          hn::Set(words, std::int16_t{255}));
    hn::StoreInterleaved4(channel(0), channel(1), channel(2), hn::DemoteTo(bytes, known), bytes,
                          out + std::ptrdiff_t{4} * x);
  }
  return x;
}

void write(const Row& row, std::uint8_t* out) {
  const int rest = write_from(hn::ScalableTag<std::int16_t>(), 0, row, out);
  write_from(hn::CappedTag<std::int16_t, 1>(), rest, row, out);
}

}  // namespace
}  // namespace hypotrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::internal {
namespace {
HWY_EXPORT(learn);
HWY_EXPORT(write);
}  // namespace

void learn_background(const std::uint8_t* picture, const std::uint8_t* models,
                      const BackgroundRow& row) {
  HWY_DYNAMIC_DISPATCH(learn)(picture, models, row);
}

void write_background(const BackgroundRow& row, std::uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(write)(row, out);
}

}  // namespace hypotrack::internal
#endif
