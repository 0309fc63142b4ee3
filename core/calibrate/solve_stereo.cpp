#include "calibrate/solve_stereo.hpp"

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <utility>

#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::calibrate {

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

void calibrate_lenses(const std::vector<CommonCorners>& views, cv::Size pictures,
                      std::array<Lens, 2>& lenses, std::array<double, 2>& focal_sigma) {
  for (std::size_t camera = 0; camera < 2; ++camera) {
    std::vector<std::vector<cv::Point3f>> board;
    std::vector<std::vector<cv::Point2f>> at;
    for (const CommonCorners& view : views) {
      board.push_back(view.board);
      at.push_back(view.at[camera]);
    }
    Lens lens;
    std::vector<cv::Mat> turns, places;
    cv::Mat sigmas, pose_sigmas, errors;
    cv::calibrateCamera(board, at, pictures, lens.matrix, lens.distortion, turns, places, sigmas,
                        pose_sigmas, errors);
    focal_sigma[camera] = sigmas.at<double>(0) / lens.matrix.at<double>(0, 0);
    lenses[camera] = std::move(lens);
  }
}

cv::Affine3d pose_of(const CommonCorners& view, std::size_t camera, const Lens& lens) {
  cv::Vec3d turn, place;
  cv::solvePnP(view.board, view.at[camera], lens.matrix, lens.distortion, turn, place);
  return cv::Affine3d(turn, place);
}

double distance_of(const CommonCorners& view, std::size_t camera, const Lens& lens,
                   const cv::Affine3d& pose) {
  std::vector<cv::Point2f> at;
  cv::projectPoints(view.board, pose.rvec(), pose.translation(), lens.matrix, lens.distortion, at);
  return cv::norm(at, view.at[camera]) / std::sqrt(static_cast<double>(at.size()));
}

CommonPose common_pose(const std::vector<CommonCorners>& views, const std::array<Lens, 2>& lenses) {
  CommonPose out;
  std::vector<cv::Affine3d> right_from_left;
  for (const CommonCorners& view : views) {
    out.boards.push_back(pose_of(view, 0, lenses[0]));
    right_from_left.push_back(pose_of(view, 1, lenses[1]) * out.boards.back().inv());
  }
  for (const cv::Affine3d& reference : right_from_left) {
    std::vector<double> distances;
    for (std::size_t i = 0; i < views.size(); ++i)
      distances.push_back(distance_of(views[i], 1, lenses[1], reference * out.boards[i]));
    if (!out.distances.empty() && !(upper_median(distances) < upper_median(out.distances)))
      continue;
    out.distances = std::move(distances);
    out.right_from_left = reference;
  }
  return out;
}

StereoSolution calibrate_both(const std::vector<CommonCorners>& views, cv::Size pictures,
                              std::array<Lens, 2>& lenses, int flags) {
  std::vector<std::vector<cv::Point3f>> board;
  std::array<std::vector<std::vector<cv::Point2f>>, 2> at;
  for (const CommonCorners& one : views) {
    board.push_back(one.board);
    for (std::size_t i = 0; i < 2; ++i) at[i].push_back(one.at[i]);
  }
  // OpenCV's own start is the median of each number of rotations, which fails near half a turn.
  const cv::Affine3d start = common_pose(views, lenses).right_from_left;
  StereoSolution out;
  out.rotation = cv::Mat(start.rotation(), true);
  out.translation = cv::Mat(start.translation(), true);
  cv::Mat essential, fundamental;
  out.rms = cv::stereoCalibrate(board, at[0], at[1], lenses[0].matrix, lenses[0].distortion,
                                lenses[1].matrix, lenses[1].distortion, pictures, out.rotation,
                                out.translation, essential, fundamental, out.residuals,
                                flags | cv::CALIB_USE_EXTRINSIC_GUESS,
                                {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 100, 1e-7});
  return out;
}

}  // namespace hypotrack::calibrate
