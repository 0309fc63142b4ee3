#include "track/faults/cell_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace hypotrack::internal {
namespace {

constexpr int kLevel = SmallPicture::kLevel;

SmallPicture row_of(std::vector<std::uint16_t> cells) {
  SmallPicture out;
  out.width = static_cast<int>(cells.size());
  out.height = 1;
  out.cells = std::move(cells);
  return out;
}

/// Two rows of one length: equal, noisy, moved and clipped cells, and motion at the limit.
std::pair<SmallPicture, SmallPicture> two_rows(int length) {
  std::mt19937 random(static_cast<unsigned>(length));
  std::vector<std::uint16_t> before, now;
  for (int i = 0; i < length; ++i) {
    const int level = kLevel * static_cast<int>(40 + random() % 200);
    const int steps[] = {0,          1, 6 * kLevel, 6 * kLevel + 1, -6 * kLevel, -6 * kLevel - 1,
                         20 * kLevel};
    before.push_back(static_cast<std::uint16_t>(level));
    now.push_back(static_cast<std::uint16_t>(
        std::clamp(level + steps[random() % std::size(steps)], 0, 255 * kLevel)));
  }
  return {row_of(before), row_of(now)};
}

TEST(CellMotion, TakesCellsTogetherAsOneByOne) {
  for (int length = 0; length < 300; ++length) {
    SCOPED_TRACE(length);
    const auto [before, now] = two_rows(length);
    const float gain = gain_between(before, now);
    std::vector<std::size_t> moved;
    std::size_t different = 0;
    for (std::size_t i = 0; i < now.cells.size(); ++i) {
      const std::uint16_t from = before.cells[i], to = now.cells[i];
      different += from != to;
      const float by = std::abs(static_cast<float>(to) - gain * static_cast<float>(from));
      if (!is_clipped(std::max(from, to)) && by > 6 * kLevel) moved.push_back(i);
    }
    EXPECT_EQ(moved_cells(before, now, gain), moved);
    EXPECT_EQ(different_cells(before, now), different);
  }
}

}  // namespace
}  // namespace hypotrack::internal
