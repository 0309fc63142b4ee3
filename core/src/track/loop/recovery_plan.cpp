#include "track/loop/recovery_plan.hpp"

#include <algorithm>
#include <cmath>

namespace hypotrack::internal {
namespace {

constexpr unsigned kPatience = 4;  // frames in a row that seek better than a poor pose

/// Returns the effort of a search for alternatives around a pose.
GlobalSearchSettings nearby_effort(const RecoverySettings& recovery) {
  constexpr double kShare = 0.1;  // of a search of one place: more finds no more of them
  return share_of({.hypotheses = recovery.hypotheses, .refined = recovery.refined, .searched = 1},
                  kShare);
}

/// Returns whether lost models are looked for in the background.
bool is_in_background(const LoopState& loop) {
  return loop.settings.recovery.run == RecoveryRun::background;
}

}  // namespace

RecoveryRequest RecoveryPlan::next(LoopState& loop, const Frame& frame, const Candidate& best) {
  const ModelFlags none(loop.tracks.size(), false);
  RecoveryRequest request{.kept = loop.tracks.kept(),
                          .together = loop.tracks.together(),
                          .sought = none,
                          .thorough = none};
  seek_lost(loop, frame, best, request);
  if (!request.lost && !any(rests_)) check_elsewhere(loop, frame, request);
  if (!request.lost && !request.contradicts) {
    seek_nearby(loop, best, request);
    if (is_in_background(loop)) request.sought = none;
  }
  return request;
}

bool RecoveryPlan::is_for_background(const LoopState& loop, const RecoveryRequest& request,
                                     const Candidate& best) {
  if (!is_in_background(loop) || !request.lost) return false;
  for (std::size_t m = 0; m < best.shown.size(); ++m)
    if (best.answers() && best.shown[m] && !request.sought[m]) return false;
  return true;
}

bool RecoveryPlan::rests(std::size_t model) {
  const unsigned count = ++poor_[model];
  return count > kPatience && count % kPatience != 0;
}

void RecoveryPlan::seek_lost(LoopState& loop, const Frame& frame, const Candidate& best,
                             RecoveryRequest& request) {
  poor_.resize(loop.tracks.size());
  rests_.assign(loop.tracks.size(), false);
  for (std::size_t m = 0; m < loop.tracks.size(); ++m) {
    ModelTrack& track = loop.tracks[m];
    const double p = best.probabilities[m];
    request.seconds.push_back(track.seconds_since_right(frame.time));
    request.unseen.push_back(track.seconds_unseen(frame.time));
    request.needed.push_back(track.needed());
    if (is_at_start(track.phase())) continue;
    if (is_unknown(track.phase())) request.together.resize(0);
    bool is_sought = !best.answers() || !best.shown[m] || p < request.needed[m];
    // A doubtful first pose may prove right.
    if (is_unknown(track.phase()) && is_sought && p >= loop.settings.thresholds.uncertain_above)
      is_sought = doubtful_finds_.next();
    const bool is_poor = best.answers() && best.shown[m] && has_pose(track.phase()) &&
                         p >= loop.settings.thresholds.uncertain_above;
    if (!is_sought) poor_[m] = std::max(std::min(poor_[m], kPatience), 1U) - 1;
    if (!is_sought) continue;
    if (!is_poor) poor_[m] = 0;
    request.thorough[m] = track.is_time_to_search_all(loop.finder.detects(m));
    rests_[m] = is_poor && rests(m);
    request.sought[m] = !rests_[m];
    request.lost = request.lost || request.sought[m];
  }
  // A search in the background is for all models that are not right.
  if (request.lost && is_in_background(loop))
    for (std::size_t m = 0; m < rests_.size(); ++m) {
      request.sought[m] = request.sought[m] || rests_[m];
      rests_[m] = false;
    }
  for (std::size_t m = 0; m < rests_.size(); ++m) loop.tracks[m].rest(rests_[m]);
}

void RecoveryPlan::check_elsewhere(const LoopState& loop, const Frame& frame,
                                   RecoveryRequest& request) {
  const double interval = loop.settings.recovery.check;
  if (!(interval > 0 && frame.time - checked_ >= interval)) return;
  checked_ = frame.time;
  const std::size_t model = checks_++ % loop.tracks.size();
  request.contradicts = request.sought[model] = loop.finder.detects(model);
}

void RecoveryPlan::seek_nearby(const LoopState& loop, const Candidate& best,
                               RecoveryRequest& request) {
  constexpr double kDoubt = 0.8;  // probability
  request.near_only = true;
  request.effort = nearby_effort(loop.settings.recovery);
  ModelFlags unconfirmed = request.sought, doubtful = request.sought;
  for (std::size_t m = 0; m < loop.tracks.size(); ++m) {
    const ModelTrack& track = loop.tracks[m];
    if (is_at_start(track.phase()) || rests_[m]) continue;
    unconfirmed[m] = track.needs_confirmation();
    doubtful[m] = best.probabilities[m] < kDoubt;
  }
  if (!any(doubtful)) doubts_.take_back();
  request.sought = any(doubtful) && doubts_.next() ? doubtful : unconfirmed;
}

void RecoveryPlan::restart() {
  doubtful_finds_.restart();
  doubts_.restart();
  poor_.clear();
}

}  // namespace hypotrack::internal
