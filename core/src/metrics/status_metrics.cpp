#include "metrics/status_metrics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace hypotrack {

std::optional<FrameVerdict> verdict_named(std::string_view word) {
  static constexpr std::array<std::string_view, 5> kNames{"tracked", "uncertain", "lost", "absent",
                                                          "missing"};
  const auto* found = std::find(kNames.begin(), kNames.end(), word);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<FrameVerdict>(found - kNames.begin());
}

void StatusCollector::Share::add(bool is_part) {
  ++of;
  part += is_part;
}

double StatusCollector::Share::value() const {
  return of > 0 ? static_cast<double>(part) / of : std::numeric_limits<double>::quiet_NaN();
}

void StatusCollector::add(const Judged& frame) {
  if (frame.verdict == FrameVerdict::solved) return;
  add_verdict(frame.verdict);
  const bool is_tracked = frame.verdict == FrameVerdict::tracked;
  if (is_tracked && (frame.some_absent || !std::isnan(frame.error_mm)))
    false_tracked_.add(frame.some_absent || frame.error_mm > kFalseErrorMm);
  if (!frame.some_absent && frame.error_mm <= kRightErrorMm) right_tracked_.add(is_tracked);
  constexpr int kGrace = 2;  // frames of an absence in which nobody needs to know of it
  absent_in_a_row_ = frame.all_absent ? absent_in_a_row_ + 1 : 0;
  if (absent_in_a_row_ > kGrace) absent_tracked_.add(is_tracked);
  add_return(frame, is_tracked && frame.error_mm <= kFalseErrorMm);
  if (frame.verdict == FrameVerdict::lost)
    least_lost_sigma_ = std::fmin(least_lost_sigma_, frame.sigma_mm);  // which passes NaN over
}

void StatusCollector::add_verdict(FrameVerdict verdict) {
  ++counts_.judged_frames;
  counts_.tracked_frames += verdict == FrameVerdict::tracked;
  counts_.uncertain_frames += verdict == FrameVerdict::uncertain;
  counts_.said_lost_frames += verdict == FrameVerdict::lost;
  counts_.absent_frames += verdict == FrameVerdict::absent;
}

void StatusCollector::add_return(const Judged& frame, bool is_right) {
  if (frame.some_absent) {
    away_ = true;
    is_back_ = false;
    return;
  }
  if (away_ && frame.in_view) {
    returns_.emplace_back();
    away_ = false;
    is_back_ = true;
  }
  if (!is_back_) return;
  Return& last = returns_.back();
  ++last.frames;
  if (is_right && last.recovered == 0) last.recovered = last.frames;
}

StatusMetrics StatusCollector::metrics() const {
  StatusMetrics m = counts_;
  const auto share_of_judged = [&](int frames) { return Share{frames, m.judged_frames}.value(); };
  m.tracked_share = share_of_judged(m.tracked_frames);
  m.uncertain_share = share_of_judged(m.uncertain_frames);
  m.absent_share = share_of_judged(m.absent_frames);
  m.false_tracked_share = false_tracked_.value();
  m.right_tracked_share = right_tracked_.value();
  m.absent_tracked_share = absent_tracked_.value();
  m.returns = static_cast<int>(returns_.size());
  Share within_2, within_10, frames;
  for (const Return& r : returns_) {
    within_2.add(r.recovered > 0 && r.recovered <= 2);
    within_10.add(r.recovered > 0 && r.recovered <= 10);
    frames.part += r.recovered;
    frames.of += r.recovered > 0;
  }
  m.recovered_2_share = within_2.value();
  m.recovered_10_share = within_10.value();
  m.frames_to_recovery = frames.value();
  m.lost_sigma_min_mm = least_lost_sigma_;
  return m;
}

}  // namespace hypotrack
