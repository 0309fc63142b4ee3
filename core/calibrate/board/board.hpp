#pragma once

#include <atomic>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
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
  /// Whether the top left square of a ChArUco board has a marker, as OpenCV before 4.6 prints it if
  /// the number of rows is even. Nothing: the pictures tell.
  std::optional<bool> marker_first;
};

/// Corners of a ChArUco board, if its markers lie in one of the two patterns.
struct PatternCorners {
  bool marker_first = false;
  int explained = 0;  ///< neighbouring markers that lie as in this pattern
  std::vector<int> ids;
  std::vector<cv::Point2f> at;
};

/// Corners of a board in a picture.
struct BoardCorners {
  std::vector<int> ids;  ///< row by row over the inner corners, ascending
  std::vector<cv::Point2f> at;
  double sigma = 0;  ///< expected standard deviation of a coordinate, in pixels; 0: unknown
  cv::Size seen;     ///< of the board in the picture, as Board has it; empty: unknown
  std::vector<PatternCorners> patterns;  ///< that are possible, of ChArUco; the first one is used
  /// Markers lie as in the pattern that Board::marker_first rules out.
  bool other_pattern = false;
  double marker = 0;  ///< measured side of a marker, as a share of a square's; 0: unknown
};

/// Returns the names of the marker dictionaries.
std::vector<std::string> dictionary_names();

/// Returns a board from `9x6` (inner corners) or `charuco:4x5` (squares) and a length as `25mm`,
/// `2.5cm` or `0.025m`. Throws ConfigError for other texts.
Board parse_board(std::string_view size, std::string_view square);
/// Returns a length in metres. Throws ConfigError, naming `what`.
double parse_length(std::string_view text, std::string_view what);

/// Numbers the corners of a whole chessboard in the right picture from the same end as in the left
/// one: most boards look the same upside down, and those of as many rows as columns (`board`) after
/// each quarter of a turn.
void number_alike(const BoardCorners& left, BoardCorners& right, cv::Size board = {});

/// Chooses the pattern that explains most markers of all pictures, and takes the corners of that.
/// One picture may not tell. Returns whether the top left square has a marker; nothing for boards
/// without markers.
std::optional<bool> settle_pattern(std::span<BoardCorners* const> pictures);

/// Returns a grey copy of an 8-bit picture, at most `widest` pixels wide if that is not 0.
/// `inverted`: white and black are exchanged.
cv::Mat gray_of(const cv::Mat& picture, bool inverted = false, int widest = 0);

class CharucoFinder;

/// Finds the corners of a board in pictures.
class BoardFinder {
 public:
  explicit BoardFinder(const Board& board);
  ~BoardFinder();
  /// Returns the corners in an 8-bit colour or grey picture; none if the board is not
  /// seen.
  BoardCorners find(const cv::Mat& picture) const;
  /// Returns find(), but only of a chessboard that is found fast, at 640 pixels of width.
  BoardCorners find_quickly(const cv::Mat& picture) const;
  /// Returns whether a picture has a part of a board in it, or something like it.
  bool sees_part(const cv::Mat& picture) const;
  /// Returns how many pixels the edges of a found chessboard are wide (OpenCV's
  /// estimateChessboardSharpness); 0 for ChArUco.
  double edge_width(const cv::Mat& picture, const BoardCorners& found) const;
  const Board& board() const { return board_; }
  /// Returns whether the board is found only as a whole.
  bool whole_only() const { return board_.kind == Board::Kind::chessboard; }
  /// Returns where a corner is on the board, in metres.
  cv::Point3f place(int id) const;

 private:
  BoardCorners chessboard(const cv::Mat& gray, bool quickly) const;
  BoardCorners with_sigma(const cv::Mat& gray, BoardCorners corners) const;

  Board board_;
  /// Slow searches for a chessboard that may still fail: they rarely find what others do not.
  mutable std::atomic<int> slow_searches_ = 3;
  std::unique_ptr<CharucoFinder> markers_;  ///< of ChArUco
};

}  // namespace hypotrack::calibrate
