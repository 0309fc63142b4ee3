#include "track/loop/frame_judge.hpp"

#include <algorithm>
#include <limits>

#include "base/profile.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Returns the status of a frame from those of its models.
Status worst(const std::vector<Status>& models) {
  if (std::ranges::all_of(models, [](Status s) { return s == Status::absent; }))
    return Status::absent;
  Status out = Status::tracked;
  for (const Status s : models) out = std::max(out, std::min(s, Status::lost));
  return out;
}

}  // namespace

void call_uncertain(Solution& solution) {
  for (Status& status : solution.models)
    if (status == Status::tracked) status = Status::uncertain;
  solution.status = worst(solution.models);
}

FrameJudge::FrameJudge(LoopState& loop) : loop_(loop) {
  if (loop.settings.uncertainty.enabled)
    uncertainty_.emplace(loop.scene, loop.settings.uncertainty);
}

Solution FrameJudge::unjudged(const Frame& frame) const {
  Solution solution;
  solution.frame = frame.index;
  solution.time = frame.time;
  solution.cost = kUnknown;
  solution.fault = frame.fault;
  solution.models.assign(loop_.tracks.size(), Status::missing);
  solution.probabilities.assign(loop_.tracks.size(), kUnknown);
  if (uncertainty_) solution.sigma.setConstant(std::ssize(loop_.scene.landmark_names()), kUnknown);
  return solution;
}

std::vector<Status> FrameJudge::judge(const Frame& frame, const Candidate& best,
                                      Solution& solution) {
  const ProfiledPart part("judge");
  solution.cost = best.found.cost;
  solution.evaluations = best.found.evaluations;
  solution.probabilities = best.probabilities;
  const StatusMeasures shared = shared_measures(frame, best, solution);
  for (std::size_t m = 0; m < loop_.tracks.size(); ++m) {
    // A detector that sees the model there confirms it as another search does.
    if (best.unseen[m] <= 0) loop_.tracks[m].see(frame.time);
    solution.models[m] = loop_.tracks[m].judge(measures_of(m, frame, best, solution, shared));
    loop_.given.conclude(frame.index, m, best.found.state, solution.models[m] == Status::tracked);
  }
  const std::vector<Status> judgement = solution.models;
  doubt_hidden(frame, best, solution);
  solution.status = worst(solution.models);
  return judgement;
}

StatusMeasures FrameJudge::shared_measures(const Frame& frame, const Candidate& best,
                                           Solution& solution) {
  StatusMeasures measures{.cost = best.found.cost, .sigma = kUnknown};
  if (!best.answers()) return measures;
  FrameSearch& search = loop_.finder.search();
  search.show(best.shown);
  const Eigen::VectorXd drawn = search.drawn(best.found.state);
  measures.visible = search.tiles().visible_share(best.found.state);
  measures.foreground_overlap = search.tiles().foreground_overlap(frame, drawn);
  if (uncertainty_) {
    const ProfiledPart part("sigmas");
    solution.sigma = uncertainty_->of(search.cost(), drawn);
    solution.evaluations += uncertainty_->evaluations();
  }
  return measures;
}

StatusMeasures FrameJudge::measures_of(std::size_t model, const Frame& frame, const Candidate& best,
                                       const Solution& solution, StatusMeasures shared) const {
  StatusMeasures own = shared;
  if (!best.shown[model]) own.cost = kInfinite;
  own.probability = best.probabilities[model];
  own.sigma = loop_.tracks[model].mean_sigma(solution.sigma);
  const ModelTrack& track = loop_.tracks[model];
  own.detected = best.is_detected(model) || track.keeps_detected();
  own.confirmed = best.confirmed[model] || best.unseen[model] <= 0 || track.keeps_confirmed();
  // What has left the pictures takes higher measures to be back.
  const bool is_back = own.probability >= loop_.settings.thresholds.confirmed_above || own.detected;
  const bool is_found = best.answers() && best.shown[model] && is_back;
  const bool is_gone =
      loop_.recovers() && !is_found && loop_.tracks.departure().is_gone(model, frame.time);
  own.in_view = best.in_view[model] && !is_gone;
  return own;
}

void FrameJudge::doubt_hidden(const Frame& frame, const Candidate& best, Solution& solution) {
  if (best.answers()) solution.hidden = loop_.finder.hidden(best.found.state);
  for (std::size_t m = 0; m < loop_.tracks.size(); ++m) {
    Status& status = solution.models[m];
    const bool is_tracked = status == Status::tracked;
    if (loop_.tracks[m].widen_hidden(solution.hidden, is_tracked, frame.time,
                                     loop_.settings.uncertain_sigma, solution.sigma) &&
        is_tracked)
      status = Status::uncertain;
  }
}

void FrameJudge::judge_without_search(const Frame& frame, Solution& solution) {
  for (std::size_t m = 0; m < loop_.tracks.size(); ++m) {
    const bool is_gone = loop_.tracks.departure().is_gone(m, frame.time);
    solution.models[m] = loop_.tracks[m].judge({.cost = kInfinite, .in_view = !is_gone});
    loop_.given.conclude(frame.index, m, loop_.trail.state(), false);
  }
  solution.status = Status::lost;
  widen(frame, solution);
}

void FrameJudge::widen(const Frame& frame, Solution& solution) const {
  for (const ModelTrack& track : loop_.tracks) track.widen(frame.time, solution.sigma);
}

}  // namespace hypotrack::internal
