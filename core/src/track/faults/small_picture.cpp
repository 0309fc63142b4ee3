#include "track/faults/small_picture.hpp"

#include <algorithm>
#include <numeric>
#include <opencv2/core/hal/intrin.hpp>
#include <utility>

#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::internal {
namespace {

constexpr int kCellsInARow = 160;
constexpr int kBlackest = 16,
              kWhitest = 250;  // grey levels of black and white cells

/// Returns the sum of so many bytes, in whole steps of 8.
std::uint32_t sum_of(const std::uint8_t* bytes, int count) {
  std::uint32_t sum = 0;
  for (; count >= 16; bytes += 16, count -= 16)
    sum += cv::v_reduce_sad(cv::v_load(bytes), cv::v_setzero_u8());
  if (count >= 8) sum += cv::v_reduce_sad(cv::v_load_low(bytes), cv::v_setzero_u8());
  return sum;
}

}  // namespace

SmallPicture shrink(const cv::Mat& color) {
  SmallPicture out;
  out.cell = std::max(1, (color.cols + kCellsInARow / 2) / kCellsInARow);
  out.width = color.cols / out.cell;
  out.height = color.rows / out.cell;
  out.cells.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
  const int bytes = 3 * out.cell;
  const int words = bytes / 8;
  // Multiplying by a reciprocal of 16 bits replaces the division.
  const auto reciprocal =
      static_cast<std::uint32_t>((SmallPicture::kLevel << 16) / (words > 0 ? 8 * words : bytes));
  std::uint16_t* cell = out.cells.data();
  for (int y = 0; y < out.height; ++y) {
    const std::uint8_t* from = color.ptr(y * out.cell + out.cell / 2);
    // Rows that are read lie too far apart for the processor to fetch the next one by itself.
    const std::size_t to_next =
        y + 1 < out.height ? color.step * static_cast<std::size_t>(out.cell) : 0;
    for (int x = 0; x < out.width; ++x, from += bytes) {
      __builtin_prefetch(from + to_next);
      const std::uint32_t sum = words > 0 ? sum_of(from, 8 * words)
                                          : std::accumulate(from, from + bytes, std::uint32_t{0});
      *cell++ = static_cast<std::uint16_t>((std::uint64_t{sum} * reciprocal) >> 16);
    }
  }
  std::uint64_t sum = 0;
  std::uint32_t black = 0, white = 0;
  for (const std::uint16_t level : out.cells) {
    sum += level;
    black += level <= kBlackest * SmallPicture::kLevel;
    white += level >= kWhitest * SmallPicture::kLevel;
  }
  const double count = std::max<double>(1, static_cast<double>(out.cells.size()));
  out.mean = static_cast<double>(sum) / (SmallPicture::kLevel * count);
  out.black = black / count;
  out.white = white / count;
  return out;
}

float gain_between(const SmallPicture& before, const SmallPicture& now) {
  constexpr std::size_t kStep = 7, kLeast = 4;  // a quarter of the cells
  constexpr int kDarkest = 16 * SmallPicture::kLevel;
  std::vector<float> clear, all;
  for (std::size_t i = 0; i < now.cells.size(); i += kStep) {
    if (before.cells[i] < kDarkest) continue;
    const std::uint16_t brighter = std::max(before.cells[i], now.cells[i]);
    all.push_back(static_cast<float>(now.cells[i]) / static_cast<float>(before.cells[i]));
    if (brighter < kWhitest * SmallPicture::kLevel) clear.push_back(all.back());
  }
  // Clipped cells tell a bound only.
  std::vector<float>& ratios = kLeast * clear.size() >= all.size() ? clear : all;
  const bool tells = kLeast * ratios.size() > now.cells.size() / kStep;
  return tells ? upper_median(std::move(ratios)) : 1.0F;
}

float LastGain::between(const std::shared_ptr<const SmallPicture>& before,
                        const std::shared_ptr<const SmallPicture>& now) {
  if (before_ != before || now_ != now) {
    gain_ = gain_between(*before, *now);
    before_ = before;
    now_ = now;
  }
  return gain_;
}

}  // namespace hypotrack::internal
