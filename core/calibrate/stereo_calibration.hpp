#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/board/board_pair.hpp"
#include "calibrate/stereo_calibration.hpp"
#include "hypotrack/api/camera.hpp"

namespace hypotrack::calibrate {

/// Residuals up to this multiple of the expected ones are those of flat boards and lenses that the
/// model describes; good ones are below 4 times.
constexpr double kFittingResidual = 5;

/// How well a pair agrees with a calibration.
struct PairResidual {
  std::string name;
  std::array<double, 2> rms{};  ///< pixels, left and right
  double expected = 0;          ///< that corners as sharp as these have, pixels; 0: unknown
  double tilt = 0;              ///< of the board to the left picture, radians
  bool too_few = true;          ///< corners that both pictures show
  bool dropped = false;         ///< an outlier
  bool exchanged = false;       ///< dropped, and the left picture fits as the right one
  /// Returns whether the calibration comes from this pair, too.
  bool counts() const { return !too_few && !dropped; }
};

/// Two cameras, and how well they are known.
struct StereoCalibration {
  std::array<Camera, 2> cameras;  ///< the left one is the world
  double rms = 0;                 ///< pixels, over all corners of the pairs that count
  /// What `rms` would be with more pairs than parameters can follow, pixels: few corners fit
  /// anything.
  double spread = 0;
  double expected = 0;  ///< of corners as sharp as these, pixels; 0: unknown
  std::vector<PairResidual> pairs;
  /// Standard deviations of the focal lengths, as shares of them; 0 if lenses were given.
  std::array<double, 2> focal_sigma{};
  double turn = 0;  ///< largest angle between the boards of two pairs that count, radians
  std::vector<std::string> faults;  ///< probable ones of the board or the pairs, in words
};

/// Calibrates two cameras from pictures of a board: Zhang's method (2000) as OpenCV has it, for
/// each camera and then for both. A pair that is far worse than most is dropped, and all is
/// calibrated again. With `lenses`, only the pose of the right camera is found. Throws DataError if
/// fewer than three pairs show the board, or if pairs do not belong together.
StereoCalibration calibrate_stereo(const BoardFinder& board, cv::Size pictures,
                                   const std::vector<BoardPair>& pairs,
                                   const std::optional<std::array<Camera, 2>>& lenses = {});

/// What a calibration is worth, in words.
struct Verdict {
  bool usable = true;
  std::string summary;              ///< one sentence
  std::vector<std::string> advice;  ///< what to do for a better one; empty: nothing
};

/// Returns what a calibration from these pairs is worth.
Verdict verdict_of(const std::vector<BoardPair>& pairs, const StereoCalibration& calibration);

/// A board in both pictures as calibrated cameras measure it.
struct BoardFit {
  double scale = 1;     ///< measured side of a square as a share of the given one
  double rms = 0;       ///< distance of the corners from the board in the pictures, pixels
  double expected = 0;  ///< of corners as sharp as these, pixels; 0: unknown
  double depth = 0;     ///< of the board's middle before the left camera, metres
  cv::Point2d centre;   ///< in the left picture, as shares of its width and height
};

/// Fits a board of unknown scale to both pictures of a pair by least squares. Returns nothing for
/// few common corners, or if their rays do not meet before the cameras.
std::optional<BoardFit> fit_board(const BoardFinder& finder, const std::array<Camera, 2>& cameras,
                                  const BoardPair& pair);

}  // namespace hypotrack::calibrate
