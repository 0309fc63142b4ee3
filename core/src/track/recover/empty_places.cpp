#include "track/recover/empty_places.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace hypotrack::internal {
namespace {

constexpr int kSide = 12;             // pixels of a patch
constexpr double kSamePlace = 0.04;   // metres
constexpr double kSamePicture = 4.0;  // mean difference of a channel, of 255
constexpr int kSearches = 2;          // of a place that does not change
constexpr int kAgain = 10;            // frames after which it is searched once more

double difference(const cv::Mat3b& a, const cv::Mat3b& b) {
  if (a.empty() || b.empty()) return a.empty() == b.empty() ? 0 : 255;
  cv::Mat3b apart;
  cv::absdiff(a, b, apart);
  const cv::Scalar sum = cv::mean(apart);
  return (sum[0] + sum[1] + sum[2]) / 3;
}

}  // namespace

EmptyPlaces::EmptyPlaces(const std::vector<Camera>& cameras, double radius)
    : cameras_(cameras), radius_(radius) {}

cv::Mat3b EmptyPlaces::patch(const Frame& frame, const Eigen::Vector3d& center,
                             std::size_t view) const {
  const Camera& camera = cameras_[view];
  const cv::Mat& picture = frame.views[view].color;
  const Eigen::Vector2d at = project(camera, center);
  const double depth = (camera.camera_from_world * center).z();
  if (!at.allFinite() || !(depth > 0) || at.cwiseAbs().maxCoeff() > 1e5) return {};
  const int half = std::max(1, static_cast<int>(std::lround(camera.fx * radius_ / depth)));
  const cv::Rect window(static_cast<int>(at.x()) - half, static_cast<int>(at.y()) - half, 2 * half,
                        2 * half);
  const cv::Rect shown = window & cv::Rect(0, 0, picture.cols, picture.rows);
  if (shown.empty()) return {};
  cv::Mat3b out;
  cv::resize(picture(shown), out, {kSide, kSide}, 0, 0, cv::INTER_AREA);
  return out;
}

bool EmptyPlaces::is_worth(const Frame& frame, const Eigen::Vector3d& center) {
  for (Place& place : places_) {
    if ((place.center - center).norm() > kSamePlace) continue;
    // Compare at the stored centre, as the place may jitter.
    bool same = true;
    for (std::size_t i = 0; i < 2; ++i)
      same = same && difference(place.patches[i], patch(frame, place.center, i)) < kSamePicture;
    if (!same) continue;
    place.seen = true;
    ++place.searches;
    return place.searches <= kSearches || place.searches % kAgain == 0;
  }
  places_.push_back({center, {patch(frame, center, 0), patch(frame, center, 1)}, 1, true});
  return true;
}

void EmptyPlaces::end_frame() {
  std::erase_if(places_, [](const Place& place) { return !place.seen; });
  for (Place& place : places_) place.seen = false;
}

}  // namespace hypotrack::internal
