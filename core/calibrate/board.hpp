#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace hypotrack::calibrate {

/// A flat calibration board. Lengths are metres.
struct Board {
  enum class Kind { chessboard, charuco };
  Kind kind = Kind::chessboard;
  cv::Size size;      ///< inner corners of a chessboard, squares of a ChArUco board
  double square = 0;  ///< side of a square
  double marker = 0;  ///< side of a marker, of ChArUco
  std::string dictionary = "4X4_50";
  bool inverted = false;  ///< white and black are exchanged
};

/// Corners of a board in a picture.
struct BoardCorners {
  std::vector<int> ids;  ///< row by row over the inner corners, ascending
  std::vector<cv::Point2f> at;
};

/// Returns the names of the marker dictionaries.
std::vector<std::string> dictionary_names();

/// Returns a board from `9x6` (inner corners) or `charuco:4x5` (squares) and a length as `25mm`,
/// `2.5cm` or `0.025m`. Throws ConfigError for other texts.
Board parse_board(std::string_view size, std::string_view square);
/// Returns a length in metres. Throws ConfigError, naming `what`.
double parse_length(std::string_view text, std::string_view what);

/// Numbers the corners of a whole chessboard in the right picture from the same end as in the left
/// one: most boards look the same upside down.
void number_alike(const BoardCorners& left, BoardCorners& right);

class CharucoFinder;

/// Finds the corners of a board in pictures.
class BoardFinder {
 public:
  explicit BoardFinder(const Board& board);
  ~BoardFinder();
  /// Returns the corners in an 8-bit colour or grey picture; none if the board is not
  /// seen.
  BoardCorners find(const cv::Mat& picture) const;
  /// Returns find(), but no chessboard that cannot be found at 640 pixels of width. Large pictures
  /// without a board then take a fraction of the time.
  BoardCorners find_quickly(const cv::Mat& picture) const;
  /// Returns whether a picture has a part of a board in it, or something like it.
  bool sees_part(const cv::Mat& picture) const;
  /// Returns how many pixels the edges of a found chessboard are wide (OpenCV's
  /// estimateChessboardSharpness); 0 for ChArUco.
  double edge_width(const cv::Mat& picture, const BoardCorners& found) const;
  /// Returns whether the board is found only as a whole.
  bool whole_only() const { return board_.kind == Board::Kind::chessboard; }
  /// Returns where a corner is on the board, in metres.
  cv::Point3f place(int id) const;

 private:
  Board board_;
  std::unique_ptr<CharucoFinder> markers_;  ///< of ChArUco
};

}  // namespace hypotrack::calibrate
