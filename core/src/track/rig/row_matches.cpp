#include "track/rig/row_matches.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "base/profile.hpp"

namespace hypotrack::internal {
namespace {

constexpr int kCoarse = 4, kFine = 7;  // half sides of patches, in half and in full pictures
constexpr int kMargin = 2 * kFine;     // pixels to the border
constexpr std::size_t kCorners = 48;

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

/// Finds a patch of the first picture in a part of the second, given both also at half their size.
std::optional<Eigen::Vector2d> find(const GreyPair& full, const GreyPair& half, const cv::Point& at,
                                    const cv::Rect& where) {
  const cv::Rect half_where(where.x / 2, where.y / 2, where.width / 2 + 1, where.height / 2 + 1);
  const auto coarse = find_coarse(half[0], at / 2, half[1], half_where);
  return coarse ? find_fine(full[0], at, full[1], *coarse * 2) : std::nullopt;
}

/// Returns corners from all over a picture, `most` of them.
std::vector<cv::Point> corners(const cv::Mat1b& picture, std::size_t most) {
  constexpr double kQuality = 0.01, kApart = 12;
  std::vector<cv::Point2f> found;
  cv::goodFeaturesToTrack(picture, found, 0, kQuality, kApart);
  std::vector<cv::Point> out;
  const cv::Rect inside(kMargin, kMargin, picture.cols - 2 * kMargin, picture.rows - 2 * kMargin);
  for (const cv::Point2f& corner : found) {
    const cv::Point at(cvRound(corner.x), cvRound(corner.y));
    if (inside.contains(at)) out.push_back(at);
  }
  if (out.size() <= most) return out;
  // The best corners alone may lie on one object.
  for (std::size_t i = 0; i < most; ++i) out[i] = out[i * out.size() / most];
  out.resize(most);
  return out;
}

}  // namespace

std::vector<RowMatch> match_rows(const GreyPair& pictures, const Eigen::Vector2d& center,
                                 const MatchRange& range) {
  const ProfiledPart part("match rows");
  const int disparity = static_cast<int>(range.disparity);
  const std::vector<cv::Point> all = corners(pictures[0], kCorners);
  GreyPair half;
  for (std::size_t v = 0; v < half.size(); ++v)
    cv::resize(pictures[v], half[v], {}, 0.5, 0.5, cv::INTER_AREA);
  std::vector<std::optional<Eigen::Vector2d>> matches(all.size());
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    const cv::Point& at = all[i];
    const cv::Rect row(at.x - disparity, at.y - range.rows, disparity + kFine, 2 * range.rows);
    matches[i] = find(pictures, half, at, row);
  });
  std::vector<RowMatch> out;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (matches[i]) out.push_back({*matches[i] - center, matches[i]->y() - all[i].y});
  return out;
}

}  // namespace hypotrack::internal
