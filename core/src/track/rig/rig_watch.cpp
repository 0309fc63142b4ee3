#include "track/rig/rig_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <tuple>
#include <utility>

namespace hypotrack::internal {
namespace {

constexpr double kSure = 4;        // standard deviations
constexpr int kFewest = 12;        // matches: three for each number that is fitted
constexpr int kInterval = 15;      // frames from one measurement to the next
constexpr double kNearest = 0.25;  // metres

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

}  // namespace

std::optional<RigWatch> RigWatch::make(const std::vector<Camera>& cameras) {
  if (cameras.size() != 2) return std::nullopt;
  auto pair = RectifiedPair::make({cameras[0], cameras[1]});
  if (!pair) return std::nullopt;
  return RigWatch(*std::move(pair));
}

void RigWatch::look(const Frame& frame) {
  if (!is_pair(frame)) return;
  const int number = frames_++;
  if (number < next_ - 1) return;
  GreyPair now = pair_.resample(frame);
  if (number == next_) {
    next_ += std::clamp(next_, 1, kInterval);
    measure(frame, now);
  }
  before_ = std::move(now);
  time_before_ = frame.time;
}

void RigWatch::measure(const Frame& frame, const GreyPair& now) {
  constexpr double kRows = 0.06;  // of the height: 20 rows of 360
  const double seconds = before_ ? frame.time - time_before_ : 0;
  const MatchRange range{pair_.disparity(kNearest), static_cast<int>(kRows * now[0].full.rows)};
  const GreyPicture none;
  fit_.add(match_rows(now, seconds > 0 ? (*before_)[0] : none, pair_.center(), range), seconds);
  if (seconds > 0) frame_time_ = std::min(frame_time_, seconds);
  estimate_ = fit_.estimate();
  if (estimate_.matches < kFewest) return;
  judge_rows(frame.index);
  judge_delay(frame.index);
}

void RigWatch::judge_rows(int frame) {
  constexpr double kFar = 1.5;  // pixels from the epipolar lines, as `calibration check` has it
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
      roll > 0 ? "clockwise" : "anticlockwise", std::abs(scale), scale > 0 ? "large" : "small",
      pixels, misaligned_ > kMostRows ? ", and frames count as uncertain" : ""));
}

void RigWatch::judge_delay(int frame) {
  // Pictures that are paired by their times are half a frame apart at most.
  const double least = frame_time_ / 2;
  const double delay = std::abs(estimate_.delay), error = kSure * estimate_.delay_sigma;
  const bool said = late_;
  late_ = late_ ? delay + error > least : delay - error > least;
  if (said || !late_) return;
  notes_.push_back(fmt::format(
      "frame {}: the {} view is {:.0f} ms ({:.1f} frames) late, judged by what moves. Depth is "
      "wrong where that moves sideways, and frames count as uncertain. Start the cameras together, "
      "or pair their pictures by time (`offset` of the source)",
      frame, estimate_.delay > 0 ? "second" : "first", 1000 * delay, delay / frame_time_));
}

void RigWatch::look_at_colors(int frame, const ColorMap& colors) {
  constexpr double kMuch = 1.25;  // times
  const double now = brightness_of(colors);
  if (!brightness_) brightness_ = now;
  const double times = now / *brightness_;
  if (brightness_said_ || (times < kMuch && times > 1 / kMuch)) return;
  brightness_said_ = true;
  notes_.push_back(fmt::format(
      "frame {}: against the first view, the second is {:.2f} times as bright as at the start; "
      "colours follow. Fix exposure, gain and white balance of the cameras",
      frame, 1 / times));
}

Frame RigWatch::applied_to(const Frame& frame) const {
  if (misaligned_ == 0 || !is_pair(frame)) return frame;
  const cv::Matx23d back = pair_.displacement(estimate_.roll, estimate_.scale, {0, estimate_.rows});
  Frame out = frame;
  View& view = out.views[1];
  for (cv::Mat* image : {&view.color, &view.mask}) {
    if (image->empty()) continue;
    const int lookup = image == &view.color ? cv::INTER_LINEAR : cv::INTER_NEAREST;
    cv::Mat moved;  // the source keeps its picture
    cv::warpAffine(*image, moved, back, image->size(), lookup | cv::WARP_INVERSE_MAP,
                   cv::BORDER_REPLICATE);
    *image = moved;
  }
  return out;
}

}  // namespace hypotrack::internal
