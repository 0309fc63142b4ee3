#pragma once

#include <array>
#include <string>
#include <vector>

#include "calibrate/solve_stereo.hpp"
#include "calibrate/stereo_calibration.hpp"

namespace hypotrack::calibrate {

/// Distance of corners from where the other pairs expect them, in pixels, up to which pictures
/// may belong together.
constexpr double kMismatch = 5;

/// Pairs of which cameras were calibrated one by one.
struct PairedViews {
  const BoardFinder* board = nullptr;
  const std::vector<BoardPair>* pairs = nullptr;
  std::vector<CommonCorners> views;
  std::array<Lens, 2> lenses;
  bool lenses_given = false;  ///< and so not of pictures that may be flipped
  cv::Size pictures;
};

/// Throws DataError if cameras cannot be those of pictures.
void expect_cameras(const std::array<Camera, 2>& cameras);

/// Throws DataError if most pairs contradict each other, and says why if that is known: pictures
/// in another order, or flipped ones.
void expect_pairs(const PairedViews& paired);

/// Returns whether the pictures of a pair fit after they are exchanged.
bool fits_exchanged(CommonCorners view, const std::array<Lens, 2>& lenses,
                    const cv::Affine3d& right_from_left);

/// Returns the faults of a board or a rig that a calibration shows, in words: squares that are
/// longer in one direction, and cameras on exchanged sides or at one place. `flags` are those of
/// calibrate_both().
std::vector<std::string> faults_of(const std::vector<CommonCorners>& views, cv::Size pictures,
                                   const std::array<Lens, 2>& lenses,
                                   const StereoCalibration& calibration, int flags);

}  // namespace hypotrack::calibrate
