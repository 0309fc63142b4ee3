#include "calibrate/board/rough_pose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace hypotrack::calibrate {

std::optional<RoughPose> rough_pose(const BoardFinder& finder, const BoardCorners& corners,
                                    cv::Size picture) {
  const double focal = 0.5 * picture.width / std::tan(std::numbers::pi / 6);
  const cv::Matx33d lens(focal, 0, 0.5 * picture.width, 0, focal, 0.5 * picture.height, 0, 0, 1);
  std::vector<cv::Point3f> board;
  cv::Point3f middle;
  for (const int id : corners.ids) board.push_back(finder.place(id));
  for (const cv::Point3f& place : board) middle += place / static_cast<float>(board.size());
  cv::Mat turn, place, rotation;
  try {
    if (board.size() < 4 ||
        !cv::solvePnP(board, corners.at, lens, {}, turn, place, false, cv::SOLVEPNP_IPPE))
      return std::nullopt;
  } catch (const cv::Exception&) {  // corners on a line
    return std::nullopt;
  }
  cv::Rodrigues(turn, rotation);
  const cv::Mat at = rotation * cv::Mat(cv::Vec3d(middle.x, middle.y, middle.z)) + place;
  const cv::Rect2f box = cv::boundingRect(corners.at);
  RoughPose out;
  out.centre = Eigen::Vector2d((box.x + box.width / 2) / static_cast<float>(picture.width),
                               (box.y + box.height / 2) / static_cast<float>(picture.height));
  out.extent = std::max(box.width / static_cast<float>(picture.width),
                        box.height / static_cast<float>(picture.height));
  out.distance = cv::norm(at);
  for (int i = 0; i < 3; ++i) out.normal[i] = rotation.at<double>(i, 2);
  if (out.normal.dot(Eigen::Vector3d(at.at<double>(0), at.at<double>(1), at.at<double>(2))) > 0)
    out.normal = -out.normal;
  if (!out.normal.allFinite() || !std::isfinite(out.distance)) return std::nullopt;
  return out;
}

double difference(const RoughPose& a, const RoughPose& b) {
  constexpr double kShift = 0.1, kTurn = 10 * std::numbers::pi / 180;
  const double turn = std::acos(std::clamp(a.normal.dot(b.normal), -1.0, 1.0));
  return std::max({(a.centre - b.centre).norm() / kShift, turn / kTurn,
                   std::abs(std::log(a.distance / b.distance)) / std::log(1.15)});
}

}  // namespace hypotrack::calibrate
