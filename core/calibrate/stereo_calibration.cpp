#include "calibrate/stereo_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <utility>

#include "calibrate/board/corner_noise.hpp"
#include "calibrate/check/faults.hpp"
#include "calibrate/solve_stereo.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::calibrate {
namespace {

constexpr std::size_t kLeastPairs = 3;

/// Moves views whose cameras stand to each other as in no other view out of `views`: pictures of
/// different moments. One would spoil the calibration of both cameras.
void drop_mismatched(std::vector<CommonCorners>& views, const std::array<Lens, 2>& lenses,
                     std::vector<PairResidual>& pairs) {
  constexpr double kFar = 5;  // medians
  const CommonPose common = common_pose(views, lenses);
  const double limit = std::max(kMismatch, kFar * upper_median(common.distances));
  const auto fits = [&](std::size_t i) { return common.distances[i] <= limit; };
  std::vector<CommonCorners> kept;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (fits(i)) kept.push_back(views[i]);
  if (kept.size() < kLeastPairs) return;
  for (std::size_t i = 0; i < views.size(); ++i) {
    PairResidual& pair = pairs[views[i].pair];
    pair.dropped = !fits(i);
    pair.exchanged = pair.dropped && fits_exchanged(views[i], lenses, common.right_from_left);
    pair.too_few = false;
    pair.rms = {distance_of(views[i], 0, lenses[0], common.boards[i]), common.distances[i]};
  }
  views = std::move(kept);
}

/// Sets the angles between boards and the plane of a picture, and the largest one between boards.
void measure_tilts(const std::vector<CommonCorners>& views, const Lens& lens,
                   StereoCalibration& out) {
  const auto angle = [](double cosine) { return std::acos(std::min(1.0, std::abs(cosine))); };
  std::vector<cv::Vec3d> normals;
  for (const CommonCorners& view : views) {
    const cv::Matx33d turn = pose_of(view, 0, lens).rotation();
    normals.emplace_back(turn(0, 2), turn(1, 2), turn(2, 2));
    out.pairs[view.pair].tilt = angle(turn(2, 2));
    for (const cv::Vec3d& other : normals)
      out.turn = std::max(out.turn, angle(other.dot(normals.back())));
  }
}

/// Moves views whose residual is far above the median out of `views`. Returns whether there were
/// any.
bool drop_outliers(std::vector<CommonCorners>& views, const cv::Mat& residuals,
                   std::vector<PairResidual>& pairs) {
  constexpr double kFar = 2.5;    // medians
  constexpr double kLeast = 0.5;  // pixels: less is no outlier
  constexpr double kMost = 0.3;   // share of the pairs
  std::vector<double> worst;
  for (int i = 0; i < residuals.rows; ++i)
    worst.push_back(std::max(residuals.at<double>(i, 0), residuals.at<double>(i, 1)));
  const double limit = std::max(kLeast, kFar * upper_median(worst));
  const auto dropped = std::ranges::count_if(pairs, &PairResidual::dropped);
  const auto left =
      static_cast<std::ptrdiff_t>(kMost * static_cast<double>(pairs.size())) - dropped;
  const auto above = std::ranges::count_if(worst, [&](double r) { return r > limit; });
  if (above == 0 || above > left || views.size() - static_cast<std::size_t>(above) < kLeastPairs)
    return false;
  std::vector<CommonCorners> kept;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (worst[i] > limit)
      pairs[views[i].pair].dropped = true;
    else
      kept.push_back(std::move(views[i]));
  }
  views = std::move(kept);
  return true;
}

/// Sets what the residuals are worth: `spread` and `expected`.
void weigh_residuals(const std::vector<BoardPair>& pairs, const std::vector<CommonCorners>& views,
                     bool lenses_given, StereoCalibration& out) {
  constexpr double kPose = 6, kLens = 9, kLeastFree = 1;
  double squares = 0, corners = 0;
  bool known = true;
  for (const CommonCorners& view : views) {
    const auto count = static_cast<double>(view.board.size());
    const double expected = expected_distance(pairs[view.pair]);
    out.pairs[view.pair].expected = expected;
    known = known && expected > 0;
    squares += count * expected * expected;
    corners += count;
  }
  const double numbers = 4 * corners;  // two coordinates in two pictures
  const double parameters =
      kPose * (1 + static_cast<double>(views.size())) + (lenses_given ? 0 : 2 * kLens);
  out.spread = out.rms * std::sqrt(numbers / std::max(kLeastFree, numbers - parameters));
  out.expected = known ? std::sqrt(squares / corners) : 0;
}

StereoCalibration calibrated(const BoardFinder& board, cv::Size pictures,
                             const std::vector<BoardPair>& pairs,
                             const std::optional<std::array<Camera, 2>>& given) {
  std::vector<CommonCorners> views = common_corners(board, pairs);
  if (views.size() < kLeastPairs) {
    throw DataError(fmt::format(
        "{} of {} pairs show the board in both pictures; expected at least {}. Are --board and its "
        "kind right, and is the whole board in view?",
        views.size(), pairs.size(), kLeastPairs));
  }
  StereoCalibration out;
  for (const BoardPair& pair : pairs) out.pairs.push_back({.name = pair.name});
  std::array<Lens, 2> lenses;
  StereoSolution found;
  int flags = given ? cv::CALIB_FIX_INTRINSIC : cv::CALIB_USE_INTRINSIC_GUESS;
  do {
    for (std::size_t i = 0; i < 2 && given; ++i) lenses[i] = lens_of((*given)[i]);
    if (!given) calibrate_lenses(views, pictures, lenses, out.focal_sigma);
    if (found.rotation.empty()) {
      expect_pairs({&board, &pairs, views, lenses, given.has_value(), pictures});
      drop_mismatched(views, lenses, out.pairs);
    }
    found = calibrate_both(views, pictures, lenses, flags);
    for (std::size_t i = 0; i < views.size(); ++i) {
      PairResidual& pair = out.pairs[views[i].pair];
      for (int k = 0; k < 2; ++k)
        pair.rms[static_cast<std::size_t>(k)] = found.residuals.at<double>(static_cast<int>(i), k);
      pair.too_few = false;
    }
  } while (drop_outliers(views, found.residuals, out.pairs));
  out.rms = found.rms;
  measure_tilts(views, lenses[0], out);
  weigh_residuals(pairs, views, given.has_value(), out);
  for (std::size_t i = 0; i < 2; ++i) out.cameras[i] = camera_of(lenses[i], pictures);
  Eigen::Isometry3d& pose = out.cameras[1].camera_from_world;
  for (int row = 0; row < 3; ++row) {
    pose.translation()[row] = found.translation.at<double>(row);
    for (int column = 0; column < 3; ++column)
      pose.linear()(row, column) = found.rotation.at<double>(row, column);
  }
  expect_cameras(out.cameras);
  out.faults = faults_of(views, pictures, lenses, out, flags);
  return out;
}

}  // namespace

StereoCalibration calibrate_stereo(const BoardFinder& board, cv::Size pictures,
                                   const std::vector<BoardPair>& pairs,
                                   const std::optional<std::array<Camera, 2>>& lenses) {
  try {
    return calibrated(board, pictures, pairs, lenses);
  } catch (const cv::Exception& e) {
    throw DataError(
        fmt::format("these pairs do not tell the cameras; expected the board tilted by 20 to 45 "
                    "degrees in several directions. OpenCV says: {}",
                    e.err));
  }
}

}  // namespace hypotrack::calibrate
