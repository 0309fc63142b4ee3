#pragma once

#include <array>
#include <optional>
#include <vector>

#include "calibrate/board/wrong_board.hpp"
#include "calibrate/check/check_reach.hpp"
#include "calibrate/picture_pairs.hpp"
#include "calibrate/stereo_calibration.hpp"

namespace hypotrack::app {

/// Compares a board in pictures with calibrated cameras.
class BoardCheck {
 public:
  explicit BoardCheck(const calibrate::Board& board) : finder_(board), seen_(board) {}

  /// Measures the board in a pair and prints the result.
  void measure(const std::array<Camera, 2>& cameras, const calibrate::PicturePair& pair);
  /// Throws DataError if no pair shows the board in both pictures.
  void expect_boards() const;
  /// Prints what the boards say together. Returns whether they agree with the cameras.
  bool print(const std::array<Camera, 2>& cameras);
  /// Returns what print() compared.
  calibrate::BoardReach reach() const;

 private:
  void calibrate_alone(const std::array<Camera, 2>& cameras);
  double residual() const;
  bool print_own(const std::array<Camera, 2>& cameras) const;

  calibrate::BoardFinder finder_;
  calibrate::SeenBoards seen_;
  std::vector<calibrate::BoardPair> pairs_;
  std::vector<calibrate::BoardFit> fits_;            ///< of `pairs_`
  std::optional<calibrate::StereoCalibration> own_;  ///< from `pairs_` alone
};

}  // namespace hypotrack::app
