#include "track/rig/view_timing.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>
#include <vector>

#include "base/profile.hpp"
#include "hypotrack/plugin/numbers.hpp"
#include "track/rig/piece_kernel.hpp"

namespace hypotrack::internal {
namespace {

constexpr int kMostLate = ViewTiming::kMostLate, kLags = 2 * kMostLate + 1;  // frames
constexpr std::size_t kMostPieces = 48;
constexpr std::size_t kVotes = 12;  // frames that agree

/// How well a piece fits the picture of a frame, and where.
struct Fit {
  double likeness = 0;
  double disparity = 0;  ///< pixels
};
using Fits = std::array<Fit, kLags>;  ///< by lag

/// Returns which pieces of a picture differ from those of another, row by row.
std::vector<bool> changed_pieces(const cv::Mat1b& now, const cv::Mat1b& then) {
  constexpr int kChange = 5 * kPieceSide * kPieceSide;  // of 255
  const int columns = now.cols / kPieceSide, rows = now.rows / kPieceSide;
  std::vector<std::uint16_t> sums(static_cast<std::size_t>(now.cols));
  std::vector<bool> out;
  for (int y = 0; y < rows; ++y) {
    sum_changes(now.ptr(y * kPieceSide), then.ptr(y * kPieceSide), now.step, sums);
    for (int x = 0; x < columns; ++x) {
      const auto first = sums.begin() + x * kPieceSide;
      out.push_back(std::accumulate(first, first + kPieceSide, 0) >= kChange);
    }
  }
  return out;
}

/// Returns the pieces of a picture that have texture and change from the frame before and to the
/// one after.
std::vector<cv::Point> moving_pieces(const cv::Mat1b& before, const cv::Mat1b& now,
                                     const cv::Mat1b& after) {
  constexpr double kTexture = 6;  // of 255
  const std::vector<bool> came = changed_pieces(now, before), goes = changed_pieces(now, after);
  const int columns = now.cols / kPieceSide;
  std::vector<cv::Point> all;
  for (std::size_t i = 0; i < came.size(); ++i) {
    if (!came[i] || !goes[i]) continue;
    const cv::Point at =
        kPieceSide * cv::Point(static_cast<int>(i) % columns, static_cast<int>(i) / columns);
    cv::Scalar mean, deviation;
    cv::meanStdDev(now(cv::Rect(at, cv::Size(kPieceSide, kPieceSide))), mean, deviation);
    if (deviation[0] > kTexture) all.push_back(at);
  }
  const std::size_t step = (all.size() + kMostPieces - 1) / kMostPieces;
  std::vector<cv::Point> some;
  for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
  return some;
}

/// Compares a piece of a picture with those of the other view, in the same rows.
Fits fits_of(const cv::Mat1b& now, const cv::Point& at, const std::array<cv::Mat1b, kLags>& others,
             double disparity) {
  const Piece piece(now.ptr(at.y) + at.x, static_cast<std::ptrdiff_t>(now.step));
  const int first = std::max(0, cvRound(at.x - 1.2 * disparity));
  const int last = std::min(now.cols, cvRound(at.x + kPieceSide + 0.2 * disparity));
  std::vector<float> likeness(static_cast<std::size_t>(last - first - kPieceSide + 1));
  Fits out;
  for (std::size_t lag = 0; lag < kLags; ++lag) {
    const cv::Mat1b& other = others[lag];
    correlate(piece, other.ptr(at.y) + first, static_cast<std::ptrdiff_t>(other.step), likeness);
    const auto best = std::ranges::max_element(likeness);
    out[lag] = {double{*best}, static_cast<double>(at.x - first - (best - likeness.begin()))};
  }
  return out;
}

/// What all pieces tell, by lag.
struct Comparison {
  std::array<double, kLags> likeness{};   ///< mean
  std::array<double, kLags> disparity{};  ///< median, against that of the same frame
};

/// Joins the fits of pieces that both views show. Returns nothing for few of them.
std::optional<Comparison> joined(const std::vector<Fits>& all) {
  constexpr std::size_t kFewestPieces = 14;
  constexpr double kAlike = 0.8;  // correlation
  Comparison out;
  std::array<std::vector<double>, kLags> disparities;
  for (const Fits& fits : all) {
    if (std::ranges::max(fits, {}, &Fit::likeness).likeness < kAlike) continue;
    for (std::size_t lag = 0; lag < kLags; ++lag) {
      out.likeness[lag] += fits[lag].likeness;
      disparities[lag].push_back(fits[lag].disparity / std::max(fits[kMostLate].disparity, 1.0));
    }
  }
  const std::size_t used = disparities[0].size();
  if (used < kFewestPieces) return {};
  for (std::size_t lag = 0; lag < kLags; ++lag) {
    out.likeness[lag] /= static_cast<double>(used);
    out.disparity[lag] = upper_median(disparities[lag]);
  }
  return out;
}

/// Returns the lag at which the views are most alike, to parts of a frame, and how much more alike
/// than in pictures of the same frame; nothing unless they clearly are. Models that move sideways
/// by a part of the baseline turn to the second camera the side that the first one saw before:
/// likeness must gain more than that brings.
std::optional<ViewTiming::Peak> peak_of(const Comparison& views) {
  constexpr double kClear = 0.01, kByDirection = 0.2;
  const auto& [likeness, disparity] = views;
  const auto at = static_cast<std::size_t>(std::ranges::max_element(likeness) - likeness.begin());
  double farther = 0;
  for (std::size_t i = 0; i < kLags; ++i)
    if (i + 1 < at || i > at + 1) farther = std::max(farther, likeness[i]);
  if (likeness[at] < farther + kClear) return {};
  const double gain =
      likeness[at] - likeness[kMostLate] - kByDirection * std::abs(disparity[at] - 1);
  if (at != kMostLate && gain < kClear) return {};
  const double lag = static_cast<double>(at) - kMostLate;
  if (at == 0 || at + 1 == kLags) return ViewTiming::Peak{lag, gain};
  // It falls about linearly to both sides.
  const double before = likeness[at - 1], after = likeness[at + 1];
  const double fall = likeness[at] - std::min(before, after);
  if (fall < kClear) return {};
  return ViewTiming::Peak{lag + 0.5 * (after - before) / fall, gain};
}

}  // namespace

void ViewTiming::add(const GreyPair& pictures) {
  const ProfiledPart part("time the views");
  ++taken_;
  recent_.push_back(pictures);
  if (recent_.size() < kLags) return;
  if (recent_.size() > kLags) recent_.pop_front();
  const cv::Mat1b& now = recent_[kMostLate][0];
  const std::vector<cv::Point> pieces =
      moving_pieces(recent_[kMostLate - 1][0], now, recent_[kMostLate + 1][0]);
  std::array<cv::Mat1b, kLags> others;
  for (std::size_t lag = 0; lag < kLags; ++lag) others[lag] = recent_[lag][1];
  std::vector<Fits> all(pieces.size());
  tbb::parallel_for(std::size_t{0}, pieces.size(),
                    [&](std::size_t i) { all[i] = fits_of(now, pieces[i], others, disparity_); });
  const std::optional<Comparison> views = joined(all);
  const std::optional<Peak> peak = views ? peak_of(*views) : std::nullopt;
  if (!peak) return;
  ++told_;
  found_.push_back(*peak);
  if (found_.size() > kVotes) found_.pop_front();
}

void ViewTiming::restart() {
  recent_.clear();
  found_.clear();
  taken_ = told_ = 0;
}

std::optional<double> ViewTiming::late() const {
  constexpr std::size_t kFew = 3;
  constexpr double kMuch = 0.06;  // frames of one moment never gained so much
  constexpr std::size_t kWrong = 2;
  const auto gains_much = [](const Peak& one) { return one.gain > kMuch; };
  if (found_.size() >= kFew && std::all_of(found_.end() - kFew, found_.end(), gains_much))
    if (const auto few = agreed(kFew, 0)) return few;
  return found_.size() < kVotes ? std::nullopt : agreed(kVotes, kWrong);
}

std::optional<double> ViewTiming::agreed(std::size_t count, std::size_t wrong) const {
  constexpr double kNear = 0.5;  // frames
  std::vector<double> lags;
  for (std::size_t i = found_.size() - count; i < found_.size(); ++i)
    lags.push_back(found_[i].frames);
  const double median = upper_median(lags);
  const auto is_near = [&](double one) { return std::abs(one - median) <= kNear; };
  const auto near = static_cast<std::size_t>(std::ranges::count_if(lags, is_near));
  return near + wrong >= count ? std::optional(median) : std::nullopt;
}

}  // namespace hypotrack::internal
