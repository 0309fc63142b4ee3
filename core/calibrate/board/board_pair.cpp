#include "calibrate/board/board_pair.hpp"

#include <algorithm>
#include <cmath>

namespace hypotrack::calibrate {

SharedCorners shared_corners(const BoardFinder& board, const BoardPair& pair) {
  const auto& [left, right] = pair.corners;
  SharedCorners out;
  for (std::size_t i = 0; i < left.ids.size(); ++i) {
    const auto j = std::ranges::find(right.ids, left.ids[i]) - right.ids.begin();
    if (j == std::ssize(right.ids)) continue;
    out.board.push_back(board.place(left.ids[i]));
    out.at[0].push_back(left.at[i]);
    out.at[1].push_back(right.at[static_cast<std::size_t>(j)]);
  }
  return out;
}

bool same_place(const BoardPair& one, const BoardPair& other) {
  constexpr double kMoved = 0.3;  // pixels, root mean square
  for (std::size_t view = 0; view < 2; ++view) {
    const BoardCorners &a = one.corners[view], &b = other.corners[view];
    if (a.ids != b.ids ||
        cv::norm(a.at, b.at) > kMoved * std::sqrt(static_cast<double>(a.at.size())))
      return false;
  }
  return true;
}

}  // namespace hypotrack::calibrate
