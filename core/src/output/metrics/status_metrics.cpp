#include "output/metrics/status_metrics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace hypotrack::internal {

std::optional<FrameStatus> status_named(std::string_view word) {
  static constexpr std::array<std::string_view, 5> kNames{"tracked", "uncertain", "lost", "absent",
                                                          "missing"};
  const auto* found = std::find(kNames.begin(), kNames.end(), word);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<FrameStatus>(found - kNames.begin());
}

void StatusCollector::Share::add(bool is_part) {
  ++of;
  part += is_part;
}

double StatusCollector::Share::value() const {
  return of > 0 ? static_cast<double>(part) / of : std::numeric_limits<double>::quiet_NaN();
}

void StatusCollector::add(FrameStatus status, const std::vector<ModelStatus>& models) {
  if (status == FrameStatus::solved) return;
  add_status(status);
  models_.resize(models.size());
  for (std::size_t m = 0; m < models.size(); ++m) add_model(models[m], models_[m]);
}

void StatusCollector::add_model(const ModelStatus& model, Presence& presence) {
  const bool is_tracked = model.status == FrameStatus::tracked;
  if (is_tracked && (model.absent || !std::isnan(model.error_mm)))
    false_tracked_.add(model.absent || model.error_mm > kFalseErrorMm);
  if (!model.absent && model.error_mm <= kRightErrorMm) right_tracked_.add(is_tracked);
  constexpr int kGrace = 2;  // frames of an absence in which a tracker need not notice it
  presence.absent_in_a_row = model.absent ? presence.absent_in_a_row + 1 : 0;
  if (presence.absent_in_a_row > kGrace) absent_tracked_.add(is_tracked);
  add_return(model, presence);
  if (model.status == FrameStatus::lost)
    least_lost_sigma_ = std::fmin(least_lost_sigma_, model.sigma_mm);  // fmin ignores NaN
}

void StatusCollector::add_status(FrameStatus status) {
  ++counts_.judged_frames;
  counts_.tracked_frames += status == FrameStatus::tracked;
  counts_.uncertain_frames += status == FrameStatus::uncertain;
  counts_.said_lost_frames += status == FrameStatus::lost;
  counts_.absent_frames += status == FrameStatus::absent;
}

void StatusCollector::add_return(const ModelStatus& model, Presence& presence) {
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
  const bool is_right = model.status == FrameStatus::tracked && model.error_mm <= kFalseErrorMm;
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

}  // namespace hypotrack::internal
