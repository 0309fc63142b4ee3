#include "track/rig/row_matches.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

namespace hypotrack::internal {
namespace {

constexpr int kCoarse = 4, kFine = 7;  // half sides of patches, in half and in full pictures
constexpr int kMargin = 2 * kFine;     // pixels to the border
constexpr int kMotion = 24;            // pixels from frame to frame
constexpr std::size_t kMoving = 16;    // corners that moved most, and as many others
constexpr std::size_t kFirst = 64;     // corners of the first picture

cv::Rect patch_at(const cv::Point& at, int half_side) {
  return {at.x - half_side, at.y - half_side, 2 * half_side + 1, 2 * half_side + 1};
}

/// Returns where a parabola through three equidistant values has its peak.
float peak(float before, float middle, float after) {
  const float bend = before - 2 * middle + after;
  return bend < 0 ? std::clamp(0.5F * (before - after) / bend, -0.5F, 0.5F) : 0;
}

/// Finds a patch of one picture in a part of another. Returns nothing unless one place is clearly
/// the best.
std::optional<cv::Point> find_coarse(const cv::Mat1b& from, const cv::Point& at,
                                     const cv::Mat1b& to, cv::Rect where) {
  constexpr double kAlike = 0.8, kDistinct = 0.05;  // correlations
  constexpr int kNear = 2;
  where = (where + cv::Size(2 * kCoarse, 2 * kCoarse)) - cv::Point(kCoarse, kCoarse);
  where &= cv::Rect({}, to.size());
  const cv::Rect patch = patch_at(at, kCoarse);
  if ((patch & cv::Rect({}, from.size())) != patch) return {};
  if (where.width < patch.width || where.height < patch.height) return {};
  cv::Mat1f alike;
  cv::matchTemplate(to(where), from(patch), alike, cv::TM_CCOEFF_NORMED);
  double best = 0, second = 0;
  cv::Point place;
  cv::minMaxLoc(alike, nullptr, &best, nullptr, &place);
  if (!(best > kAlike)) return {};
  alike(patch_at(place, kNear) & cv::Rect({}, alike.size())) = -1;
  cv::minMaxLoc(alike, nullptr, &second);
  if (!(second < best - kDistinct)) return {};
  return place + where.tl() + cv::Point(kCoarse, kCoarse);
}

/// Finds a patch near a place of another picture, to parts of a pixel.
std::optional<Eigen::Vector2d> find_fine(const cv::Mat1b& from, const cv::Point& at,
                                         const cv::Mat1b& to, const cv::Point& near) {
  constexpr double kAlike = 0.85;  // correlation
  constexpr int kReach = 4;        // a coarse place may be 2 pixels off
  const cv::Rect where = patch_at(near, kFine + kReach), patch = patch_at(at, kFine);
  if ((where & cv::Rect({}, to.size())) != where) return {};
  if ((patch & cv::Rect({}, from.size())) != patch) return {};
  cv::Mat1f alike;
  cv::matchTemplate(to(where), from(patch), alike, cv::TM_CCOEFF_NORMED);
  double best = 0;
  cv::Point place;
  cv::minMaxLoc(alike, nullptr, &best, nullptr, &place);
  const auto [x, y] = std::pair(place.x, place.y);
  if (!(best > kAlike) || x == 0 || y == 0 || x == 2 * kReach || y == 2 * kReach) return {};
  const auto top = static_cast<float>(best);
  return Eigen::Vector2d(near.x + x - kReach + double{peak(alike(y, x - 1), top, alike(y, x + 1))},
                         near.y + y - kReach + double{peak(alike(y - 1, x), top, alike(y + 1, x))});
}

std::optional<Eigen::Vector2d> find(const GreyPicture& from, const cv::Point& at,
                                    const GreyPicture& to, const cv::Rect& where) {
  const cv::Rect half(where.x / 2, where.y / 2, where.width / 2 + 1, where.height / 2 + 1);
  const auto coarse = find_coarse(from.half, at / 2, to.half, half);
  return coarse ? find_fine(from.full, at, to.full, *coarse * 2) : std::nullopt;
}

/// Returns corners of a picture, those first where it changed most since another one.
std::vector<cv::Point> corners(const cv::Mat1b& now, const cv::Mat1b& before) {
  constexpr double kQuality = 0.01, kApart = 12;
  std::vector<cv::Point2f> found;
  cv::goodFeaturesToTrack(now, found, 0, kQuality, kApart);
  std::vector<std::pair<double, cv::Point>> sorted;
  const cv::Rect inside(kMargin, kMargin, now.cols - 2 * kMargin, now.rows - 2 * kMargin);
  for (const cv::Point2f& corner : found) {
    const cv::Point at(cvRound(corner.x), cvRound(corner.y));
    if (!inside.contains(at)) continue;
    const cv::Rect patch = patch_at(at, kFine);
    const double change = before.empty() ? 0 : cv::norm(now(patch), before(patch), cv::NORM_L1);
    sorted.emplace_back(-change, at);
  }
  std::ranges::stable_sort(sorted, {}, [](const auto& one) { return one.first; });
  std::vector<cv::Point> out;
  for (const auto& [change, at] : sorted) out.push_back(at);
  return out;
}

}  // namespace

std::vector<RowMatch> match_rows(const GreyPair& now, const GreyPicture& before,
                                 const Eigen::Vector2d& center, const MatchRange& range) {
  const bool knows_motion = !before.full.empty();
  const std::size_t moving = knows_motion ? kMoving : 0;
  const std::size_t all = knows_motion ? 2 * kMoving : kFirst;
  std::vector<cv::Point> places = corners(now[0].full, before.full);
  if (places.size() > all) {  // the others from all over the picture
    const double step =
        static_cast<double>(places.size() - moving) / static_cast<double>(all - moving);
    for (std::size_t i = moving; i < all; ++i)
      places[i] = places[moving + static_cast<std::size_t>(step * static_cast<double>(i - moving))];
    places.resize(all);
  }
  std::vector<RowMatch> out;
  for (const cv::Point& at : places) {
    const int disparity = static_cast<int>(range.disparity);
    const cv::Rect row(at.x - disparity, at.y - range.rows, disparity + kFine, 2 * range.rows);
    const auto second = find(now[0], at, now[1], row);
    if (!second) continue;
    Eigen::Vector2d motion(0, 0);
    if (knows_motion) {
      const auto earlier = find(now[0], at, before, patch_at(at, kMotion));
      if (!earlier) continue;
      motion = Eigen::Vector2d(at.x, at.y) - *earlier;
    }
    out.push_back({*second - center, second->y() - at.y, motion});
  }
  return out;
}

}  // namespace hypotrack::internal
