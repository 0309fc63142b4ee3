// Compiled once per instruction set: an include below includes this file again.
#include "tile/grid_lookup.hpp"

#define HWY_TARGET_INCLUDE "tile/grid_lookup.cpp"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <hypotrack/plugin/foreach_target-inl.hpp>
#include <opencv2/imgproc.hpp>

#ifndef HYPOTRACK_GRID_LOOKUP_ONCE
#define HYPOTRACK_GRID_LOOKUP_ONCE
namespace hypotrack::grid_lookup {

constexpr int kChannels = 3;
constexpr std::size_t kWidest = 16;                     // lanes of any instruction set
constexpr int kBehind = 2 * static_cast<int>(kWidest);  // pixels that may be read behind a row

/// Columns of a grid: those of each sample of an output pixel follow each other, padded to whole
/// vectors.
struct Columns {
  int size = 0;  ///< output pixels in a row
  int samples = 1;
  std::size_t padded = 0;
  std::vector<std::int32_t> first, second, share;

  std::size_t numbers() const { return static_cast<std::size_t>(samples) * padded; }
};

/// Two interpolated rows between which a row of samples lies.
struct Between {
  const std::int32_t *top, *bottom;
  std::int32_t share;  ///< of the bottom row, in 32nds
};

}  // namespace hypotrack::grid_lookup
#endif

HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace grid_lookup;

using Ints = hn::CappedTag<std::int32_t, kWidest>;
using Words = hn::Rebind<std::uint32_t, Ints>;
using Bytes = hn::Rebind<std::uint8_t, Ints>;
constexpr Ints d;
constexpr std::size_t kLanes = hn::MaxLanes(Ints());

/// Returns pixels of a row at columns from `first` on. Nearly always they lie within two vectors,
/// which takes less time than a gather.
HWY_INLINE hn::Vec<Words> pixels_at(const std::uint32_t* row, const std::int32_t* columns,
                                    std::int32_t first, bool is_near) {
  const auto column = hn::LoadU(d, columns);
  if (!is_near) return hn::GatherIndex(Words(), row, column);
  const auto offset = hn::Sub(column, hn::Set(d, first));
  const auto lane = hn::And(offset, hn::Set(d, static_cast<std::int32_t>(kLanes) - 1));
  const auto index = hn::IndicesFromVec(Words(), lane);
  const auto low = hn::TableLookupLanes(hn::LoadU(Words(), row + first), index);
  const auto high = hn::TableLookupLanes(hn::LoadU(Words(), row + first + kLanes), index);
  const auto is_low = hn::Lt(offset, hn::Set(d, static_cast<std::int32_t>(kLanes)));
  return hn::IfThenElse(hn::RebindMask(Words(), is_low), low, high);
}

/// Interpolates a row of an image (8-bit BGRA), with kBehind pixels behind it, at all columns, in
/// 32nds. `out` has the numbers of each channel of a sample after each other.
void along_row(const std::uint32_t* pixels, const Columns& columns, std::int32_t* out) {
  const auto byte = hn::Set(Words(), 255u);
  for (std::size_t i = 0; i < columns.numbers(); i += kLanes) {
    const std::int32_t first = columns.first[i];
    const bool is_near =
        columns.second[i + kLanes - 1] < first + 2 * static_cast<std::int32_t>(kLanes);
    const auto p = pixels_at(pixels, columns.first.data() + i, first, is_near);
    const auto q = pixels_at(pixels, columns.second.data() + i, first, is_near);
    const auto share = hn::LoadU(d, columns.share.data() + i);
    const auto blend = [&](auto from, auto to, std::int32_t* at) HWY_ATTR {
      const auto a = hn::BitCast(d, hn::And(from, byte)), b = hn::BitCast(d, hn::And(to, byte));
      hn::StoreU(hn::Add(hn::ShiftLeft<5>(a), hn::Mul(share, hn::Sub(b, a))), d, at);
    };
    std::int32_t* at = out + kChannels * (i / columns.padded * columns.padded) + i % columns.padded;
    blend(p, q, at);
    blend(hn::ShiftRight<8>(p), hn::ShiftRight<8>(q), at + columns.padded);
    blend(hn::ShiftRight<16>(p), hn::ShiftRight<16>(q), at + 2 * columns.padded);
  }
}

/// Returns the sum of a channel's samples of some output pixels.
template <int kSamples>
HWY_INLINE hn::Vec<Ints> sum_samples(const Between* rows, std::size_t padded, std::size_t at) {
  const auto half = hn::Set(d, 1 << 9);
  auto sum = hn::Zero(d);
  for (int y = 0; y < kSamples; ++y)
    for (int x = 0; x < kSamples; ++x) {
      const std::size_t i = at + static_cast<std::size_t>(x) * kChannels * padded;
      const auto top = hn::LoadU(d, rows[y].top + i), bottom = hn::LoadU(d, rows[y].bottom + i);
      const auto value =
          hn::Add(hn::ShiftLeft<5>(top), hn::Mul(hn::Set(d, rows[y].share), hn::Sub(bottom, top)));
      sum = hn::Add(sum, hn::ShiftRight<10>(hn::Add(value, half)));
    }
  return kSamples == 1 ? sum : hn::ShiftRight<2>(hn::Add(sum, hn::Set(d, 2)));
}

template <int kSamples>
HWY_INLINE void write_row(const Between* rows, std::size_t padded, std::uint8_t* out) {
  for (std::size_t i = 0; i < padded; i += kLanes) {
    const auto channel = [&](std::size_t k) HWY_ATTR {
      return hn::DemoteTo(Bytes(), sum_samples<kSamples>(rows, padded, k * padded + i));
    };
    hn::StoreInterleaved3(channel(0), channel(1), channel(2), Bytes(), out + kChannels * i);
  }
}

/// Writes a row of output pixels. `out` has room for the padded ones.
void across_rows(const Between* rows, const Columns& columns, std::uint8_t* out) {
  columns.samples == 1 ? write_row<1>(rows, columns.padded, out)
                       : write_row<2>(rows, columns.padded, out);
}

}  // namespace
}  // namespace hypotrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::internal {
namespace {

using namespace grid_lookup;

HWY_EXPORT(along_row);
HWY_EXPORT(across_rows);

Columns columns_of(const AxisPlaces& places, int samples) {
  Columns out;
  const auto step = static_cast<std::size_t>(samples), size = places.first.size() / step;
  out.size = static_cast<int>(size);
  out.samples = samples;
  out.padded = (size + kWidest - 1) / kWidest * kWidest;
  for (std::size_t s = 0; s < step; ++s)
    for (std::size_t i = 0; i < out.padded; ++i) {
      const std::size_t from = std::min(i, size - 1) * step + s;
      out.first.push_back(places.first[from]);
      out.second.push_back(places.second[from]);
      out.share.push_back(places.share[from]);
    }
  return out;
}

/// Rows of an image, interpolated at the columns when they are first asked for.
class RowCache {
 public:
  RowCache(const cv::Mat4b& image, const Columns& columns, int kept)
      : image_(image),
        columns_(columns),
        kept_(kept),
        numbers_(kChannels * columns.numbers()),
        rows_(static_cast<std::size_t>(kept) * numbers_),
        which_(static_cast<std::size_t>(kept), -1) {}

  /// Returns a row. It stays valid while no row is asked for that is `kept` later or more.
  const std::int32_t* row(int y) {
    const auto place = static_cast<std::size_t>(y % kept_);
    std::int32_t* out = rows_.data() + place * numbers_;
    if (which_[place] != y) HWY_DYNAMIC_DISPATCH(along_row)
    (reinterpret_cast<const std::uint32_t*>(image_[y]), columns_, out);
    which_[place] = y;
    return out;
  }

 private:
  const cv::Mat4b& image_;
  const Columns& columns_;
  int kept_;
  std::size_t numbers_;
  std::vector<std::int32_t> rows_;
  std::vector<int> which_;
};

/// Returns the most rows of the image that an output row lies between.
int most_rows(const AxisPlaces& rows, int samples) {
  const auto step = static_cast<std::size_t>(samples);
  int most = 1;
  for (std::size_t i = 0; i < rows.first.size(); i += step)
    most = std::max(most, rows.second[i + step - 1] - rows.first[i] + 1);
  return most;
}

}  // namespace

AxisPlaces axis_places(std::span<const float> positions, int end) {
  AxisPlaces out;
  for (const float position : positions) {
    const int fine = cvRound(position * 32);
    out.first.push_back(std::clamp(fine >> 5, 0, end - 1));
    out.second.push_back(std::clamp((fine >> 5) + 1, 0, end - 1));
    out.share.push_back(fine & 31);
  }
  return out;
}

cv::Mat3b look_up_grid(const cv::Mat3b& image, const AxisPlaces& columns, const AxisPlaces& rows,
                       int samples) {
  cv::Mat4b pixels(image.rows, image.cols + kBehind);  // words can be looked up at once
  cv::cvtColor(image, pixels.colRange(0, image.cols), cv::COLOR_BGR2BGRA);
  const Columns across = columns_of(columns, samples);
  RowCache cache(pixels, across, most_rows(rows, samples));
  cv::Mat3b out(static_cast<int>(rows.first.size()) / samples, across.size);
  std::vector<std::uint8_t> bytes(kChannels * across.padded);
  for (int y = 0; y < out.rows; ++y) {
    Between between[2];
    for (int s = 0; s < samples; ++s) {
      const auto i = static_cast<std::size_t>(y * samples + s);
      const std::int32_t* top = cache.row(rows.first[i]);
      between[s] = {top, cache.row(rows.second[i]), rows.share[i]};
    }
    HWY_DYNAMIC_DISPATCH(across_rows)(between, across, bytes.data());
    std::memcpy(out[y], bytes.data(), static_cast<std::size_t>(kChannels * across.size));
  }
  return out;
}

}  // namespace hypotrack::internal
#endif
