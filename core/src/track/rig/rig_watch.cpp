#include "track/rig/rig_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <tuple>
#include <utility>
#include <vector>

#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kSure = 4;        // standard deviations
constexpr int kFewest = 12;        // matches: three for each number that is fitted
constexpr double kNearest = 0.25;  // metres
constexpr double kFar = 1.5;       // pixels from the epipolar lines, as `calibration check` has it

bool is_pair(const Frame& frame) {
  if (frame.views.size() != 2) return false;
  return std::ranges::all_of(frame.views, [](const View& view) {
    return view.color.type() == CV_8UC3 && !view.color.empty() && view.depth.empty();
  });
}

/// Returns the brightness, of 255, that a map makes of a middle grey.
double brightness_of(const ColorMap& colors) {
  constexpr double kMiddle = 128;
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    sum += double{colors.gain[i]} * kMiddle + double{colors.offset[i]};
  return sum / 3;
}

/// Returns the median of angles, and their quartile on its side of zero: three quarters of them are
/// farther out. The quartile is negative if they are on the other side.
std::pair<double, double> median_and_quartile(std::vector<double> angles) {
  std::ranges::sort(angles);
  const std::size_t quarter = angles.size() / 4;
  const double median = angles[angles.size() / 2];
  return {median, median > 0 ? angles[quarter] : -angles[angles.size() - 1 - quarter]};
}

}  // namespace

std::optional<RigWatch> RigWatch::make(const std::vector<Camera>& cameras, bool corrects_turn) {
  if (cameras.size() != 2) return std::nullopt;
  auto pair = RectifiedPair::make({cameras[0], cameras[1]});
  if (!pair) return std::nullopt;
  return RigWatch(*std::move(pair), corrects_turn);
}

RigWatch::RigWatch(RectifiedPair pair, bool corrects_turn)
    : pair_(std::move(pair)), timing_(pair_.disparity(kNearest)), corrects_turn_(corrects_turn) {}

void RigWatch::look(const Frame& frame) {
  constexpr std::size_t kRecent = 15;  // frames
  is_moved_ = is_pair(frame);
  if (!is_moved_) return;
  const int number = frames_++;
  const double since = number > 0 ? frame.time - time_ : 0;
  time_ = frame.time;
  if (since > 0) intervals_.push_back(since);
  if (intervals_.size() > kRecent) intervals_.pop_front();
  const bool looks = number >= timed_from_;
  if (number < next_ && !looks) return;
  // The time between the views is told by pictures whose rows fit.
  const GreyPair pictures = pair_.resample(frame);
  if (number >= next_) {
    next_ += std::clamp(next_, 1, kInterval);
    look_at_rows(pictures, frame.index);
  }
  if (looks)
    look_at_time(misaligned_ > 0 ? pair_.resample(corrected(frame, correction())) : pictures,
                 frame.index);
}

void RigWatch::look_at_rows(const GreyPair& pictures, int frame) {
  constexpr double kRows = 0.06;  // of the height: 20 rows of 360
  const MatchRange range{pair_.disparity(kNearest), static_cast<int>(kRows * pictures[0].rows)};
  fit_.add(match_rows(pictures, pair_.center(), range));
  estimate_ = fit_.estimate();
  if (estimate_.matches < kFewest) return;
  const double pixels = pair_.scale() * estimate_.row_error;
  const double sure = pixels - kSure * pair_.scale() * estimate_.row_error_sigma;
  const bool said = misaligned_ > 0;
  if (sure < kFar && !said) return;
  misaligned_ = pixels;
  if (said) return;
  const auto [rows, roll, scale] =
      std::tuple(pair_.scale() * estimate_.rows, estimate_.roll * 180 / std::numbers::pi,
                 100 * estimate_.scale);
  notes_.push_back(fmt::format(
      "frame {}: against the calibration, the second view is {:.1f} rows too {}, {:.2f} degrees "
      "rolled {} and {:.1f} % too {}; that is {:.1f} px from the epipolar lines. Its pictures are "
      "moved to fit{}. Check the cameras with `hypotrack calibration check`, and calibrate again",
      frame, std::abs(rows), rows > 0 ? "low" : "high", std::abs(roll),
      roll > 0 ? "clockwise" : "counterclockwise", std::abs(scale), scale > 0 ? "large" : "small",
      pixels, misaligned_ > kMostRows ? ", and frames count as uncertain" : ""));
}

void RigWatch::look_at_time(const GreyPair& pictures, int frame) {
  constexpr int kRest = 150, kMost = 60;  // frames
  constexpr double kLate = 0.6;  // cameras without a common trigger are half a frame apart at most
  timing_.add(pictures);
  const std::optional<double> late = timing_.late();
  is_timed_ = is_timed_ || late;
  if (late || timing_.told() >= kMost || (is_timed_ && timing_.taken() >= kMost)) {
    timed_from_ = frames_ + kRest;
    timing_.restart();
  }
  if (!late) return;
  is_late_ = std::abs(*late) > kLate;
  if (!is_late_ || std::exchange(late_said_, true)) return;
  const double frames = std::abs(*late);
  std::string milliseconds;
  if (!intervals_.empty()) {
    const double interval = upper_median(std::vector(intervals_.begin(), intervals_.end()));
    milliseconds = fmt::format(" ({:.0f} ms)", 1000 * frames * interval);
  }
  notes_.push_back(fmt::format(
      "frame {}: the {} view is {:.1f} frames late{}{}, judged by what moves. Depth is "
      "wrong while models move sideways, and frames count as uncertain. Start the cameras "
      "together, or pair their pictures by time (`offset` of the source)",
      frame, *late > 0 ? "second" : "first", frames, milliseconds,
      frames < ViewTiming::kMostLate ? "" : " or more"));
}

void RigWatch::look_at_colors(int frame, const ColorMap& colors) {
  constexpr double kMuch = 1.25;              // times
  constexpr int kLearning = 5, kLasting = 5;  // frames
  const double now = brightness_of(colors);
  if (color_frames_ < kLearning) {
    ++color_frames_;
    brightness_ = now;
    return;
  }
  const double times = now / brightness_;
  other_frames_ = times < kMuch && times > 1 / kMuch ? 0 : other_frames_ + 1;
  if (other_frames_ < kLasting || std::exchange(brightness_said_, true)) return;
  notes_.push_back(fmt::format(
      "frame {}: against the first view, the second is {:.2f} times as bright as at the start; "
      "colours follow. Fix exposure, gain and white balance of the cameras",
      frame, 1 / times));
}

void RigWatch::look_at_turn(int frame, const CameraTurn& turn) {
  constexpr std::ptrdiff_t kEnough = 12;  // frames
  constexpr double kMost = 0.04;          // radians: more is no slip of a camera
  constexpr double kWrong = 0.02;         // metres
  const double focal = pair_.scale() * pair_.focal();
  const bool is_sharp = turn.sigma > 0 && turn.sigma * focal < kFar && std::isfinite(turn.angle);
  if (!is_moved_ || !is_sharp) return;
  turns_.push_back(turn.angle);
  if (std::ssize(turns_) < 2 * kEnough) return;
  // Colours of the outlines are learned in the first frames, where they are wrong with the start.
  const auto [before, before_sure] = median_and_quartile({turns_.begin(), turns_.end() - kEnough});
  const auto [median, sure] = median_and_quartile({turns_.end() - kEnough, turns_.end()});
  turns_.erase(turns_.begin(), turns_.end() - kEnough);
  const double least = turn_said_ ? 0 : kFar;
  const bool lasts = std::min(before_sure, sure) * focal > least && (before > 0) == (median > 0);
  if (!lasts) return;
  turns_.clear();
  if (corrects_turn_) turn_ = std::clamp(turn_ + median, -kMost, kMost);
  const double share = pair_.focal() * std::abs(median) / pair_.disparity(turn.distance);
  is_turned_ = !corrects_turn_ && share * turn.distance > kWrong;
  if (std::exchange(turn_said_, true)) return;
  notes_.push_back(fmt::format(
      "frame {}: the outlines of models in both views disagree by at least {:.1f} px. Either the "
      "second camera is turned by {:.2f} degrees {} against the calibration, or its baseline is "
      "{:.1f} % too {}, or the models are that much too {}. {}. Check the models' sizes, and "
      "calibrate again",
      frame, std::abs(median) * focal, std::abs(median) * 180 / std::numbers::pi,
      median > 0 ? "inwards" : "outwards", 100 * share, median > 0 ? "long" : "short",
      median > 0 ? "small" : "large",
      corrects_turn_
          ? "The second view's pictures are moved to fit"
          : "If it is the camera, `status.correct_turn: true` moves its pictures to fit"));
}

std::optional<cv::Matx33d> RigWatch::correction() const {
  if (misaligned_ == 0 && turn_ == 0) return std::nullopt;
  const cv::Matx33d turned = pair_.turned(turn_);
  if (misaligned_ == 0) return turned;
  return pair_.displacement(estimate_.roll, estimate_.scale, {0, estimate_.rows}) * turned;
}

Frame corrected(const Frame& frame, const std::optional<cv::Matx33d>& correction) {
  if (!correction || !is_pair(frame)) return frame;
  Frame out = frame;
  View& view = out.views[1];
  for (cv::Mat* image : {&view.color, &view.mask}) {
    if (image->empty()) continue;
    const int lookup = image == &view.color ? cv::INTER_LINEAR : cv::INTER_NEAREST;
    cv::Mat moved;  // the source keeps its picture
    cv::warpPerspective(*image, moved, *correction, image->size(), lookup | cv::WARP_INVERSE_MAP,
                        cv::BORDER_REPLICATE);
    *image = moved;
  }
  return out;
}

}  // namespace hypotrack::internal
