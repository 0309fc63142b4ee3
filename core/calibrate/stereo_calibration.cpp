#include "calibrate/stereo_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/affine.hpp>
#include <utility>

#include "hypotrack/error.hpp"
#include "hypotrack/median.hpp"

namespace hypotrack::calibrate {
namespace {

constexpr std::size_t kLeastPairs = 3;

/// Corners of a pair, which has an index among the given ones.
struct CommonCorners : SharedCorners {
  std::size_t pair = 0;
};

/// One camera's matrix and distortion.
struct Lens {
  cv::Mat matrix, distortion;
};

std::vector<CommonCorners> common_corners(const BoardFinder& board,
                                          const std::vector<BoardPair>& pairs) {
  std::vector<CommonCorners> out;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    SharedCorners shared = shared_corners(board, pairs[i]);
    if (shared.board.size() >= kLeastCorners) out.push_back({std::move(shared), i});
  }
  return out;
}

Lens lens_of(const Camera& camera) {
  return {(cv::Mat_<double>(3, 3) << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1),
          cv::Mat(camera.distortion, true).reshape(1, 1)};
}

/// A calibrated camera.
struct OneCamera {
  Lens lens;
  double focal_sigma = 0;   ///< standard deviation of the focal length as a share of it
  bool tangential = false;  ///< the tangential distortion differs from 0
};

OneCamera calibrate_one(const std::vector<CommonCorners>& views, std::size_t view,
                        cv::Size pictures, int flags) {
  constexpr double kSignificant = 3;  // standard deviations
  std::vector<std::vector<cv::Point3f>> board;
  std::vector<std::vector<cv::Point2f>> at;
  for (const CommonCorners& one : views) {
    board.push_back(one.board);
    at.push_back(one.at[view]);
  }
  OneCamera out;
  std::vector<cv::Mat> turns, places;
  cv::Mat sigmas, pose_sigmas, errors;
  cv::calibrateCamera(board, at, pictures, out.lens.matrix, out.lens.distortion, turns, places,
                      sigmas, pose_sigmas, errors, flags);
  out.focal_sigma = sigmas.at<double>(0) / out.lens.matrix.at<double>(0, 0);
  for (int i = 2; i < 4; ++i)  // after four of the matrix and two radial ones
    out.tangential = out.tangential || std::abs(out.lens.distortion.at<double>(i)) >
                                           kSignificant * sigmas.at<double>(4 + i);
  return out;
}

/// Calibrates both cameras. Where neither shows tangential distortion, none is assumed: it trades
/// off against the centre, which is known twice as well without it. Returns OpenCV's flag of that.
int calibrate_lenses(const std::vector<CommonCorners>& views, cv::Size pictures,
                     std::array<Lens, 2>& lenses, std::array<double, 2>& focal_sigma) {
  const auto calibrate = [&](int flags) {
    bool tangential = false;
    for (std::size_t i = 0; i < 2; ++i) {
      const OneCamera one = calibrate_one(views, i, pictures, flags);
      lenses[i] = one.lens;
      focal_sigma[i] = one.focal_sigma;
      tangential = tangential || one.tangential;
    }
    return tangential;
  };
  if (calibrate(0)) return 0;
  calibrate(cv::CALIB_ZERO_TANGENT_DIST);
  return cv::CALIB_ZERO_TANGENT_DIST;
}

/// The right camera's pose and the residuals of each view.
struct Pair {
  cv::Mat rotation, translation, residuals;
  double rms = 0;
};

Pair calibrate_both(const std::vector<CommonCorners>& views, cv::Size pictures,
                    std::array<Lens, 2>& lenses, int flags) {
  std::vector<std::vector<cv::Point3f>> board;
  std::array<std::vector<std::vector<cv::Point2f>>, 2> at;
  for (const CommonCorners& one : views) {
    board.push_back(one.board);
    for (std::size_t i = 0; i < 2; ++i) at[i].push_back(one.at[i]);
  }
  Pair out;
  cv::Mat essential, fundamental;
  out.rms = cv::stereoCalibrate(board, at[0], at[1], lenses[0].matrix, lenses[0].distortion,
                                lenses[1].matrix, lenses[1].distortion, pictures, out.rotation,
                                out.translation, essential, fundamental, out.residuals, flags,
                                {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 100, 1e-7});
  return out;
}

cv::Affine3d pose_of(const CommonCorners& view, std::size_t camera, const Lens& lens) {
  cv::Vec3d turn, place;
  cv::solvePnP(view.board, view.at[camera], lens.matrix, lens.distortion, turn, place);
  return cv::Affine3d(turn, place);
}

/// Returns the root mean square distance of a picture's corners from those of a board in a pose.
double distance_of(const CommonCorners& view, std::size_t camera, const Lens& lens,
                   const cv::Affine3d& pose) {
  std::vector<cv::Point2f> at;
  cv::projectPoints(view.board, pose.rvec(), pose.translation(), lens.matrix, lens.distortion, at);
  return cv::norm(at, view.at[camera]) / std::sqrt(static_cast<double>(at.size()));
}

/// Moves views whose cameras stand to each other as in no other view out of `views`: pictures of
/// different moments. One would spoil the calibration of both cameras. The reference is the view
/// that most agree with (least median of squares: Rousseeuw 1984).
void drop_mismatched(std::vector<CommonCorners>& views, const std::array<Lens, 2>& lenses,
                     std::vector<PairResidual>& pairs) {
  constexpr double kFar = 5;    // medians
  constexpr double kLeast = 5;  // pixels
  std::vector<cv::Affine3d> left, right_from_left;
  for (const CommonCorners& view : views) {
    left.push_back(pose_of(view, 0, lenses[0]));
    right_from_left.push_back(pose_of(view, 1, lenses[1]) * left.back().inv());
  }
  std::vector<double> best;
  for (const cv::Affine3d& reference : right_from_left) {
    std::vector<double> distances;
    for (std::size_t i = 0; i < views.size(); ++i)
      distances.push_back(distance_of(views[i], 1, lenses[1], reference * left[i]));
    if (best.empty() || upper_median(distances) < upper_median(best)) best = std::move(distances);
  }
  const double limit = std::max(kLeast, kFar * upper_median(best));
  const auto mismatched = std::ranges::count_if(best, [&](double d) { return !(d <= limit); });
  if (views.size() - static_cast<std::size_t>(mismatched) < kLeastPairs) return;
  std::vector<CommonCorners> kept;
  for (std::size_t i = 0; i < views.size(); ++i) {
    PairResidual& pair = pairs[views[i].pair];
    pair.dropped = !(best[i] <= limit);
    pair.too_few = false;
    pair.rms = {distance_of(views[i], 0, lenses[0], left[i]), best[i]};
    if (!pair.dropped) kept.push_back(std::move(views[i]));
  }
  views = std::move(kept);
}

/// Returns the angle between a board and the plane of a picture.
double tilt_of(const CommonCorners& view, const Lens& lens) {
  return std::acos(std::min(1.0, std::abs(pose_of(view, 0, lens).rotation()(2, 2))));
}

Camera camera_of(const Lens& lens, cv::Size pictures) {
  Camera out;
  out.width = pictures.width;
  out.height = pictures.height;
  out.fx = lens.matrix.at<double>(0, 0);
  out.fy = lens.matrix.at<double>(1, 1);
  out.cx = lens.matrix.at<double>(0, 2);
  out.cy = lens.matrix.at<double>(1, 2);
  out.distortion_model = lens.distortion.empty() ? DistortionModel::none : DistortionModel::brown;
  for (int i = 0; i < static_cast<int>(lens.distortion.total()); ++i)
    out.distortion.push_back(lens.distortion.at<double>(i));
  return out;
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
  Pair found;
  do {
    int flags = cv::CALIB_FIX_INTRINSIC;
    for (std::size_t i = 0; i < 2 && given; ++i) lenses[i] = lens_of((*given)[i]);
    if (!given)
      flags = cv::CALIB_USE_INTRINSIC_GUESS |
              calibrate_lenses(views, pictures, lenses, out.focal_sigma);
    if (found.rotation.empty()) drop_mismatched(views, lenses, out.pairs);
    found = calibrate_both(views, pictures, lenses, flags);
    for (std::size_t i = 0; i < views.size(); ++i) {
      PairResidual& pair = out.pairs[views[i].pair];
      for (int k = 0; k < 2; ++k)
        pair.rms[static_cast<std::size_t>(k)] = found.residuals.at<double>(static_cast<int>(i), k);
      pair.tilt = tilt_of(views[i], lenses[0]);
      pair.too_few = false;
    }
  } while (drop_outliers(views, found.residuals, out.pairs));
  out.rms = found.rms;
  weigh_residuals(pairs, views, given.has_value(), out);
  for (std::size_t i = 0; i < 2; ++i) out.cameras[i] = camera_of(lenses[i], pictures);
  Eigen::Isometry3d& pose = out.cameras[1].camera_from_world;
  for (int row = 0; row < 3; ++row) {
    pose.translation()[row] = found.translation.at<double>(row);
    for (int column = 0; column < 3; ++column)
      pose.linear()(row, column) = found.rotation.at<double>(row, column);
  }
  for (const Camera& camera : out.cameras) validate(camera, "these pairs do not tell the cameras");
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
