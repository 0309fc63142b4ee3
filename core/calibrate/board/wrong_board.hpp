#pragma once

#include <map>
#include <string>
#include <utility>

#include "calibrate/board/board.hpp"

namespace hypotrack::calibrate {

/// Returns that a picture shows a board of another size than the given one. Returns nothing for
/// the same size, an unknown one, or a board of which a part may be seen.
std::string other_size(const Board& given, cv::Size seen);

/// Counts the boards that pictures show.
class SeenBoards {
 public:
  explicit SeenBoards(Board given) : given_(std::move(given)) {}
  void add(const BoardCorners& picture);
  /// Returns that most pictures show a board of another size or pattern, and which. Returns nothing
  /// before some pictures show one while none shows the given one.
  std::string early_problem() const;
  /// Returns the same for all pictures together.
  std::string problem() const { return problem(2); }

 private:
  std::string problem(int least) const;
  std::string pattern_problem(int least) const;

  Board given_;
  int pictures_ = 0, found_ = 0, other_patterns_ = 0;
  std::map<std::pair<int, int>, int> seen_;  ///< pictures by columns and rows
};

/// Returns why no board is found in a picture, as a phrase: `too dark`, `blurred`, ...
std::string why_no_board(const BoardFinder& finder, const cv::Mat& picture);

/// Returns what to change of the options so that a board is found in a picture: the markers, the
/// kind of the board, a mirrored picture or white for black. Returns nothing if that is not known.
std::string better_options(const Board& given, const cv::Mat& picture);

}  // namespace hypotrack::calibrate
