#include "correspondence_lines.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace hypotrack::contour {
namespace {

constexpr float kClosest = 0.01f;  // metres from the camera
constexpr float kFarthest = 1e6f;  // pixels
constexpr float kLeast = 3;        // segments that a part must be wide, and the gap beside it

/// Finds the pixel at a place of a picture. Returns false beside the picture.
inline bool find_pixel(const Eigen::Vector2f& place, const cv::Size& size, cv::Point& pixel) {
  const float x = place.x() + 0.5f, y = place.y() + 0.5f;
  pixel = {static_cast<int>(x), static_cast<int>(y)};
  return x >= 0 && y >= 0 && pixel.x < size.width && pixel.y < size.height;
}

/// Returns whether a line can be looked at: wide enough on both sides, in the picture, not behind
/// another model.
bool is_open(const SeenPoint& point, const RegionView& view, float segment) {
  if (std::min(point.inside, point.outside) < kLeast * segment) return false;
  cv::Point pixel;
  if (!find_pixel(point.pixel, view.pixels.color.size(), pixel)) return false;
  return view.nearest.empty() || view.nearest(pixel) >= view.distance;
}

}  // namespace

float extent_of(const ContourViews& model, const Eigen::Isometry3f& camera_from_model,
                const TileCamera& camera) {
  constexpr float kWithPadding = 1.5f;  // on both sides, and where perspective makes it wider
  const float z = (camera_from_model * model.centre()).z();
  const float own = kWithPadding * 2 * model.radius() * static_cast<float>(camera.fx) / z;
  return z > kClosest ? std::min(own, static_cast<float>(camera.width))
                      : static_cast<float>(camera.width);
}

std::optional<SeenPoint> seen(const ContourPoint& point, const Eigen::Isometry3f& camera_from_model,
                              const TileCamera& camera) {
  SeenPoint out;
  out.position = camera_from_model * point.position;
  const float z = out.position.z();
  if (!(z > kClosest)) return std::nullopt;
  const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
  out.pixel = {fx * out.position.x() / z + static_cast<float>(camera.cx),
               fy * out.position.y() / z + static_cast<float>(camera.cy)};
  if (!(out.pixel.cwiseAbs().maxCoeff() < kFarthest)) return std::nullopt;
  if (!point.front.isZero()) {
    const Eigen::Vector3f to_camera = -(camera_from_model.linear().transpose() * out.position);
    if (point.front.dot(to_camera) < 0 || point.back.dot(to_camera) > 0) return std::nullopt;
  }
  const Eigen::Vector3f plane = camera_from_model.linear() * point.normal;
  const Eigen::Vector2f normal(plane.x() / fx, plane.y() / fy);
  const float length = normal.norm();
  if (!(length > 0)) return std::nullopt;
  out.normal = normal / length;
  const float scale = fx / z;
  out.inside = scale * point.inside;
  out.outside = scale * point.outside;
  return out;
}

std::vector<CorrespondenceLine> find_lines(std::span<const ContourPoint> outline,
                                           const Eigen::Isometry3f& camera_from_model,
                                           const RegionView& view, int scale) {
  const auto pixels = static_cast<float>(scale);
  std::vector<const ContourPoint*> points;
  std::vector<PixelLine> across;
  for (const ContourPoint& point : outline) {
    const std::optional<SeenPoint> here = seen(point, camera_from_model, *view.camera);
    if (!here || !is_open(*here, view, pixels)) continue;
    points.push_back(&point);
    across.push_back({here->pixel, here->normal});
  }
  std::vector<Place> places(points.size());
  find_places(view.pixels, across, scale, places);
  std::vector<CorrespondenceLine> out;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::isfinite(places[i].variance))
      out.push_back({points[i]->position, across[i].middle, across[i].normal,
                     places[i].mean * pixels, places[i].variance * pixels * pixels});
  return out;
}

void add_cover(std::span<const ContourPoint> outline, const Eigen::Isometry3f& camera_from_model,
               const TileCamera& camera, float distance, cv::Mat1f& nearest) {
  constexpr int kAround = 3;  // pixels: colours of the edge are mixtures
  std::vector<cv::Point> places, hull;
  for (const ContourPoint& point : outline)
    if (const std::optional<SeenPoint> here = seen(point, camera_from_model, camera))
      places.emplace_back(cvRound(here->pixel.x()), cvRound(here->pixel.y()));
  if (places.empty()) return;
  cv::convexHull(places, hull);
  cv::Rect box = cv::boundingRect(hull);
  box -= cv::Point(kAround, kAround);
  box += cv::Size(2 * kAround, 2 * kAround);
  box &= cv::Rect({}, nearest.size());
  if (box.empty()) return;
  cv::Mat1b covered(box.size(), uchar{0});
  for (cv::Point& corner : hull) corner -= box.tl();
  cv::fillConvexPoly(covered, hull, 255);
  cv::dilate(covered, covered, cv::Mat1b::ones(2 * kAround + 1, 2 * kAround + 1));
  cv::Mat1f part = nearest(box);
  part.setTo(distance, covered & (part > distance));
}

double count_colors(std::span<const ContourPoint> outline,
                    const Eigen::Isometry3f& camera_from_model, const ColorView& seen_in,
                    float reach, ColorHistograms& histograms) {
  const cv::Mat3b color = seen_in.view->color;
  const cv::Mat1b valid = seen_in.view->valid;
  const bool is_alone = seen_in.nearest.empty();
  const auto is_hidden = [&](const cv::Point& pixel) {
    return !is_alone && seen_in.nearest(pixel) < seen_in.distance;
  };
  const cv::Size size = color.size();
  std::size_t shown = 0;
  const auto count = [&](Eigen::Vector2f at, const Eigen::Vector2f& step, float length, bool on) {
    at += step;  // pixels on the outline are mixtures
    for (float out = 2; out < std::min(length, reach); ++out) {
      at += step;
      cv::Point pixel;
      if (!find_pixel(at, size, pixel) || valid(pixel) == 0 || is_hidden(pixel)) return;
      if (on && out == 2) ++shown;
      histograms.count(color(pixel), on);
    }
  };
  for (const ContourPoint& point : outline) {
    const std::optional<SeenPoint> here = seen(point, camera_from_model, seen_in.view->camera);
    if (!here) continue;
    count(here->pixel, -here->normal, here->inside, true);
    count(here->pixel, here->normal, here->outside, false);
  }
  return outline.empty() ? 0 : static_cast<double>(shown) / static_cast<double>(outline.size());
}

}  // namespace hypotrack::contour
