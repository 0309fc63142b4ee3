#include "correspondence_lines.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "hypotrack/plugin/pixel.hpp"
#include "line_distribution.hpp"

namespace hypotrack::contour {
namespace {

constexpr float kClosest = 0.01f;  // metres from the camera
constexpr float kFarthest = 1e6f;  // pixels
constexpr float kLeast = 3;        // segments that a part must be wide, and the gap beside it

/// Sums the log odds of the pixels of each segment of a line. Pixels beside the picture say
/// nothing.
Segments sum_segments(const cv::Mat1f& log_odds, const SeenPoint& point, int scale) {
  Segments out{};
  const float from = -0.5f * static_cast<float>(kSegments * scale - 1);
  Eigen::Vector2f at = point.pixel + from * point.normal;
  for (float& segment : out)
    for (int i = 0; i < scale; ++i, at += point.normal) {
      if (!(at.x() > -0.5f) || !(at.y() > -0.5f)) continue;
      const int x = static_cast<int>(at.x() + 0.5f), y = static_cast<int>(at.y() + 0.5f);
      if (x < log_odds.cols && y < log_odds.rows) segment += log_odds(y, x);
    }
  return out;
}

/// Returns whether most segments just inside a place show colours that were seen on neither side:
/// something else is before the model.
bool is_hidden(const Segments& log_odds, const Place& place) {
  constexpr float kNoEvidence = 1e-4f;
  constexpr int kInside = kSupport / 2;
  int unseen = 0;
  for (int k = 0; k < kSegments; ++k) {
    const float off = from_middle(k) - place.mean;
    if (off < 0 && off >= -kInside && std::abs(log_odds[static_cast<std::size_t>(k)]) < kNoEvidence)
      ++unseen;
  }
  return 2 * unseen > kInside;
}

/// Returns the place of the outline on a line; nothing where the model is hidden. Lines of
/// one-pixel segments are refined.
std::optional<Place> place_of(const SeenPoint& point, const RegionView& view, int scale) {
  const Segments log_odds = sum_segments(view.log_odds, point, scale);
  Segments likeness;
  for (std::size_t k = 0; k < likeness.size(); ++k)
    likeness[k] = 2 / (1 + pixel::exp(-log_odds[k])) - 1;
  const Place place = find_place(likeness);
  if (is_hidden(log_odds, place)) return std::nullopt;
  return scale > 1 ? place : refine_place(place, view.color, point.pixel, point.normal);
}

}  // namespace

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
  std::vector<CorrespondenceLine> out;
  const auto pixels = static_cast<float>(scale);
  for (const ContourPoint& point : outline) {
    const std::optional<SeenPoint> here = seen(point, camera_from_model, *view.camera);
    if (!here || std::min(here->inside, here->outside) < kLeast * pixels) continue;
    const int x = static_cast<int>(std::floor(here->pixel.x() + 0.5f));
    const int y = static_cast<int>(std::floor(here->pixel.y() + 0.5f));
    if (x < 0 || y < 0 || x >= view.color.cols || y >= view.color.rows) continue;
    if (!view.hidden.empty() && view.hidden(y, x) != 0) continue;
    const std::optional<Place> place = place_of(*here, view, scale);
    if (!place) continue;
    out.push_back({point.position, here->pixel, here->normal, place->mean * pixels,
                   place->variance * pixels * pixels});
  }
  return out;
}

cv::Mat1b covered_by(std::span<const ContourPoint> outline,
                     const Eigen::Isometry3f& camera_from_model, const TileCamera& camera) {
  std::vector<cv::Point> places, hull;
  for (const ContourPoint& point : outline)
    if (const std::optional<SeenPoint> here = seen(point, camera_from_model, camera))
      places.emplace_back(cvRound(here->pixel.x()), cvRound(here->pixel.y()));
  cv::Mat1b out(camera.height, camera.width, uchar{0});
  if (places.empty()) return out;
  cv::convexHull(places, hull);
  cv::fillConvexPoly(out, hull, 255);
  constexpr int kAround = 7;  // pixels: colours of the edge are mixtures
  cv::dilate(out, out, cv::Mat1b::ones(kAround, kAround));
  return out;
}

double count_colors(std::span<const ContourPoint> outline,
                    const Eigen::Isometry3f& camera_from_model, const TileView& view,
                    ColorHistograms& histograms) {
  const cv::Mat3b color = view.color;
  const cv::Mat1b valid = view.valid;
  const float reach = static_cast<float>(color.cols) / 8;  // pixels from the outline
  std::size_t shown = 0;
  const auto count = [&](Eigen::Vector2f at, const Eigen::Vector2f& step, float length, bool on) {
    at += step;  // pixels on the outline are mixtures
    for (float out = 2; out < std::min(length, reach); ++out) {
      at += step;
      const int x = static_cast<int>(std::floor(at.x() + 0.5f));
      const int y = static_cast<int>(std::floor(at.y() + 0.5f));
      if (x < 0 || y < 0 || x >= color.cols || y >= color.rows || valid(y, x) == 0) return;
      if (on && out == 2) ++shown;
      histograms.count(color(y, x), on);
    }
  };
  for (const ContourPoint& point : outline) {
    const std::optional<SeenPoint> here = seen(point, camera_from_model, view.camera);
    if (!here) continue;
    count(here->pixel, -here->normal, here->inside, true);
    count(here->pixel, here->normal, here->outside, false);
  }
  return outline.empty() ? 0 : static_cast<double>(shown) / static_cast<double>(outline.size());
}

}  // namespace hypotrack::contour
