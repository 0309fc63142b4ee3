#include "output/metrics/status_metrics.hpp"

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

void StatusCollector::add(FrameVerdict verdict, const std::vector<Judged>& models) {
  if (verdict == FrameVerdict::solved) return;
  add_verdict(verdict);
  models_.resize(models.size());
  for (std::size_t m = 0; m < models.size(); ++m) add_model(models[m], models_[m]);
}

void StatusCollector::add_model(const Judged& model, Presence& presence) {
  const bool is_tracked = model.verdict == FrameVerdict::tracked;
  if (is_tracked && (model.absent || !std::isnan(model.error_mm)))
    false_tracked_.add(model.absent || model.error_mm > kFalseErrorMm);
  if (!model.absent && model.error_mm <= kRightErrorMm) right_tracked_.add(is_tracked);
  constexpr int kGrace = 2;  // frames of an absence in which nobody needs to know of it
  presence.absent_in_a_row = model.absent ? presence.absent_in_a_row + 1 : 0;
  if (presence.absent_in_a_row > kGrace) absent_tracked_.add(is_tracked);
  add_return(model, presence);
  if (model.verdict == FrameVerdict::lost)
    least_lost_sigma_ = std::fmin(least_lost_sigma_, model.sigma_mm);  // which passes NaN over
}

void StatusCollector::add_verdict(FrameVerdict verdict) {
  ++counts_.judged_frames;
  counts_.tracked_frames += verdict == FrameVerdict::tracked;
  counts_.uncertain_frames += verdict == FrameVerdict::uncertain;
  counts_.said_lost_frames += verdict == FrameVerdict::lost;
  counts_.absent_frames += verdict == FrameVerdict::absent;
}

void StatusCollector::add_return(const Judged& model, Presence& presence) {
  if (model.absent) {
    if (presence.is_back) returns_.push_back(presence.last);
    presence.away = true;
    presence.is_back = false;
    return;
  }
  if (presence.away && model.in_view) {
    presence.away = false;
    presence.is_back = true;
    presence.last = {};
  }
  if (!presence.is_back) return;
  Return& last = presence.last;
  ++last.frames;
  const bool is_right = model.verdict == FrameVerdict::tracked && model.error_mm <= kFalseErrorMm;
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
  std::vector<Return> returns = returns_;
  for (const Presence& model : models_)
    if (model.is_back) returns.push_back(model.last);
  m.returns = static_cast<int>(returns.size());
  Share within_2, within_10, frames;
  for (const Return& r : returns) {
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
