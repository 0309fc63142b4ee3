#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/board/board.hpp"
#include "calibrate/picture_pairs.hpp"
#include "calibrate/stereo_calibration.hpp"

namespace hypotrack::app {

/// Pairs of pictures with the board, and names of those without.
struct FoundBoards {
  std::vector<calibrate::BoardPair> pairs;
  std::vector<std::string> without;
  std::vector<std::string> repeated;  ///< of pairs that show the board where another one does
  cv::Size size;                      ///< of the pictures
  bool interrupted = false;           ///< before there were enough pairs
  std::string advice;                 ///< what to change so that more is found; may be empty
  std::string why;                    ///< the first pair without the board has none
};

/// Finds the board in pairs of pictures, as read_pairs() reads them, and says on a terminal how far
/// it is. Throws DataError if the sizes of the pictures differ, or soon if they show another board
/// or are split in the wrong way.
FoundBoards find_boards(const calibrate::BoardFinder& finder, const calibrate::PairFiles& files);

/// Reads pairs of pictures, calls `take` for each, and prints notes on how they are read.
void read_noted_pairs(const calibrate::PairFiles& files,
                      const std::function<void(calibrate::PicturePair)>& take);

/// Settles which pattern the markers of a board have. Pairs that do not have it go to `without`.
/// Returns a line for the user; empty for boards without markers.
std::string settle_pattern(const calibrate::Board& board, FoundBoards& boards);

/// Returns that markers have another size than the board says; empty if they do not, or if that is
/// not known.
std::string marker_note(const calibrate::Board& board, const FoundBoards& boards);

/// Throws DataError if too few pairs show the board, or if they show one of another size.
void expect_board(const calibrate::Board& board, const FoundBoards& boards);

}  // namespace hypotrack::app
