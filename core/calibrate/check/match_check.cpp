#include "calibrate/check/match_check.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <utility>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::calibrate {
namespace {

constexpr double kNear = 2;  // pixels from the epipolar line

/// Pixels of matching features in two pictures.
using Matches = std::array<Eigen::Matrix2Xd, 2>;

Matches matches_of(const cv::Mat& left, const cv::Mat& right) {
  constexpr int kFeatures = 4000;
  constexpr float kDistinct = 0.75f;  // of the distance of the second-best match
  const auto sift = cv::SIFT::create(kFeatures);
  std::array<std::vector<cv::KeyPoint>, 2> points;
  std::array<cv::Mat, 2> descriptors;
  sift->detectAndCompute(left, cv::noArray(), points[0], descriptors[0]);
  sift->detectAndCompute(right, cv::noArray(), points[1], descriptors[1]);
  std::vector<std::pair<int, int>> pairs;
  if (descriptors[0].rows > 1 && descriptors[1].rows > 1) {
    std::vector<std::vector<cv::DMatch>> found;
    cv::BFMatcher().knnMatch(descriptors[0], descriptors[1], found, 2);
    for (const auto& match : found)
      if (match.size() == 2 && match[0].distance < kDistinct * match[1].distance)
        pairs.emplace_back(match[0].queryIdx, match[0].trainIdx);
  }
  Matches out{Eigen::Matrix2Xd(2, std::ssize(pairs)), Eigen::Matrix2Xd(2, std::ssize(pairs))};
  for (Eigen::Index i = 0; i < std::ssize(pairs); ++i) {
    const auto [a, b] = pairs[static_cast<std::size_t>(i)];
    const cv::Point2f p = points[0][static_cast<std::size_t>(a)].pt,
                      q = points[1][static_cast<std::size_t>(b)].pt;
    out[0].col(i) << p.x, p.y;
    out[1].col(i) << q.x, q.y;
  }
  return out;
}

/// Returns pixels as a lens without distortion shows them.
std::vector<cv::Point2d> as_pinhole(const Camera& camera, const Eigen::Matrix2Xd& pixels) {
  const Eigen::Matrix3Xd rays = back_project(camera, pixels);
  std::vector<cv::Point2d> out;
  for (const auto& ray : rays.colwise()) out.emplace_back(camera.fy * ray.x(), camera.fy * ray.y());
  return out;
}

/// Returns the matches that agree with one fundamental matrix (RANSAC): chance ones do not.
Matches without_chance(const std::array<Camera, 2>& cameras, const Matches& matches) {
  constexpr int kLeast = 15;      // for a fundamental matrix that means something
  constexpr double kApart = 1.5;  // pixels from the epipolar line
  constexpr double kSure = 0.999;
  const Eigen::Index count = matches[0].cols();
  if (count < kLeast) return matches;
  const std::array points = {as_pinhole(cameras[0], matches[0]),
                             as_pinhole(cameras[1], matches[1])};
  cv::Mat agrees;
  cv::theRNG().state = 1;
  cv::findFundamentalMat(points[0], points[1], cv::FM_RANSAC, kApart, kSure, agrees);
  if (agrees.total() != static_cast<std::size_t>(count)) return matches;
  Matches out{Eigen::Matrix2Xd(2, count), Eigen::Matrix2Xd(2, count)};
  Eigen::Index kept = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (!agrees.at<uchar>(static_cast<int>(i))) continue;
    for (std::size_t view = 0; view < 2; ++view) out[view].col(kept) = matches[view].col(i);
    ++kept;
  }
  for (Eigen::Matrix2Xd& pixels : out) pixels.conservativeResize(2, kept);
  return out;
}

/// Returns whether a homography explains nearly all matches: those of a plane.
bool lie_on_a_plane(const std::array<Camera, 2>& cameras,
                    const std::array<std::vector<cv::Point2f>, 2>& pixels) {
  constexpr std::size_t kLeast = 8;
  constexpr double kApart = 3, kNearlyAll = 0.8;  // pixels, share
  if (pixels[0].size() < kLeast) return false;
  std::array<std::vector<cv::Point2d>, 2> points;
  for (std::size_t view = 0; view < 2; ++view) {
    Eigen::Matrix2Xd at(2, std::ssize(pixels[view]));
    for (Eigen::Index i = 0; i < at.cols(); ++i) {
      const cv::Point2f& p = pixels[view][static_cast<std::size_t>(i)];
      at.col(i) << p.x, p.y;
    }
    points[view] = as_pinhole(cameras[view], at);
  }
  cv::Mat agrees;
  cv::theRNG().state = 1;
  cv::findHomography(points[0], points[1], cv::RANSAC, kApart, agrees);
  return cv::countNonZero(agrees) > kNearlyAll * static_cast<double>(pixels[0].size());
}

/// Distances of matches from their epipolar lines, and whether they may be points before both
/// cameras.
struct Distances {
  std::vector<double> signed_pixels;
  double consistent = 0;
  MatchedPoints points;
};

/// Returns the distances in the second picture. A point is before both cameras if the rays meet
/// there.
Distances distances(const std::array<Camera, 2>& cameras, const Matches& matches) {
  const Eigen::Isometry3d second_from_first =
      cameras[1].camera_from_world * cameras[0].camera_from_world.inverse();
  const Eigen::Vector3d t = second_from_first.translation();
  const Eigen::Matrix3Xd first = back_project(cameras[0], matches[0]);
  const Eigen::Matrix3Xd second = back_project(cameras[1], matches[1]);
  Distances out;
  for (Eigen::Index i = 0; i < first.cols(); ++i) {
    const Eigen::Vector3d p = second_from_first.linear() * first.col(i), q = second.col(i);
    const Eigen::Vector3d line = t.cross(p);  // of the epipolar line, in the second camera
    const double pixels = cameras[1].fy * q.dot(line) / line.head<2>().norm();
    if (!std::isfinite(pixels)) continue;
    out.signed_pixels.push_back(line.y() < 0 ? -pixels : pixels);
    // z p + t = w q: the depths in both cameras by least squares.
    Eigen::Matrix<double, 3, 2> rays;
    rays << p, -q;
    const Eigen::Vector2d depths = rays.colPivHouseholderQr().solve(-t);
    if (!(std::abs(pixels) < kNear && depths.minCoeff() > 0)) continue;
    ++out.consistent;
    out.points.depths.push_back(depths[0]);
    for (std::size_t view = 0; view < 2; ++view)
      out.points.pixels[view].emplace_back(static_cast<float>(matches[view](0, i)),
                                           static_cast<float>(matches[view](1, i)));
  }
  if (!out.signed_pixels.empty()) out.consistent /= static_cast<double>(out.signed_pixels.size());
  return out;
}

}  // namespace

bool MatchCheck::looks_exchanged() const {
  constexpr double kClearly = 2, kLeast = 0.2;
  return consistent_exchanged > kLeast && consistent_exchanged > kClearly * consistent;
}

MatchCheck check_matches(const std::array<Camera, 2>& cameras, const cv::Mat& left,
                         const cv::Mat& right) {
  const Matches matches = without_chance(cameras, matches_of(left, right));
  const Distances given = distances(cameras, matches);
  MatchCheck out;
  out.matches = static_cast<int>(given.signed_pixels.size());
  if (out.matches == 0) return out;
  out.consistent = given.consistent;
  out.points = given.points;
  out.points.flat = lie_on_a_plane(cameras, out.points.pixels);
  out.offset = upper_median(given.signed_pixels);
  std::vector<double> lengths;
  for (const double pixels : given.signed_pixels) lengths.push_back(std::abs(pixels));
  out.distance = upper_median(std::move(lengths));
  out.consistent_exchanged = distances(cameras, {matches[1], matches[0]}).consistent;
  return out;
}

}  // namespace hypotrack::calibrate
