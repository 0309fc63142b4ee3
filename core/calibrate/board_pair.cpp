#include "calibrate/board_pair.hpp"

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

double expected_distance(const BoardPair& pair) {
  const double left = pair.corners[0].sigma, right = pair.corners[1].sigma;
  return left > 0 && right > 0 ? std::hypot(left, right) : 0;
}

}  // namespace hypotrack::calibrate
