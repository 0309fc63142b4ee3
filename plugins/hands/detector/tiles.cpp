#include "tiles.hpp"

#include <algorithm>
#include <cmath>

namespace hypotrack::hands {
namespace {

/// Returns where the tiles of a row or column begin, at equal steps of half a side at most.
std::vector<int> starts(int length, int side) {
  if (length <= side) return {0};
  const int count = 1 + (2 * (length - side) + side - 1) / side;
  std::vector<int> out;
  for (int i = 0; i < count; ++i) out.push_back((length - side) * i / (count - 1));
  return out;
}

}  // namespace

std::vector<int> tile_sides(const cv::Size& picture, double smallest_hand) {
  if (smallest_hand <= 0) return {};
  constexpr double kSideOfHand = 6.4;  // the palm detector finds hands of a share of the picture
  constexpr double kApart = 2.5;       // sides: tiles find hands up to half their side
  constexpr int kSmallest = 64;
  const double first = std::max(picture.width, picture.height);
  const double last = std::max(smallest_hand * kSideOfHand, double{kSmallest});
  if (first <= last) return {};
  const auto count = static_cast<int>(std::ceil(std::log(first / last) / std::log(kApart)));
  std::vector<int> out;
  for (int i = 1; i <= count; ++i)
    out.push_back(static_cast<int>(std::lround(first * std::pow(last / first, double(i) / count))));
  return out;
}

std::vector<cv::Rect> tiles(const cv::Size& picture, int side) {
  std::vector<cv::Rect> out;
  for (const int y : starts(picture.height, side)) {
    for (const int x : starts(picture.width, side)) {
      out.emplace_back(x, y, std::min(side, picture.width - x), std::min(side, picture.height - y));
    }
  }
  return out;
}

}  // namespace hypotrack::hands
