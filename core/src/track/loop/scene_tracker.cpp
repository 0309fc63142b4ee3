#include "track/loop/scene_tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "base/stop_scope.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/search.hpp"
#include "plugin/plugin_call.hpp"
#include "track/faults/fault_text.hpp"
#include "track/sighting.hpp"
#include "track/tangent.hpp"
#include "track/term_maps.hpp"

namespace hypotrack::internal {
namespace {

// Number of first frames that are searched from several starts.
constexpr int kPatientFrames = 3;
// Interval, in frames, of searches from several starts while nothing was ever found.
constexpr int kSeveralAgain = 5;
// Frames after a loss in which alternative poses are searched although one looks right.
constexpr int kConfirmations = 4;
// Effort of searches for alternatives around a pose, as a share of that of a search of one place.
// More of it finds no more of them.
constexpr double kNearbyShare = 0.1;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Derives a seed for every frame (splitmix64 of both numbers). So a frame's search does not depend
/// on how many random numbers earlier frames used.
std::uint64_t frame_seed(std::uint64_t seed, int frame) {
  std::uint64_t z = seed + 0x9e3779b97f4a7c15ULL * (static_cast<std::uint64_t>(frame) + 1);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// Turns evidence off where no term looks at pictures.
StatusSettings of_pictures(StatusSettings settings, const std::vector<ObjectiveTerm>& terms) {
  settings.evidence = settings.evidence && look_at_pictures(terms);
  return settings;
}

/// Returns the root mean square distance that a scene may have moved since it was last seen, in
/// metres.
double sigma_after(double seconds) {
  constexpr double kAtOnce = 0.03, kPerSecond = 0.3;
  return kAtOnce + kPerSecond * std::max(seconds, 0.0);
}

/// Returns the effort of a search for alternatives around a pose.
GlobalSearchSettings nearby_effort(const RecoverySettings& recovery) {
  const auto share = [](int whole) {
    return std::max(1, static_cast<int>(std::lround(kNearbyShare * whole)));
  };
  return {
      .hypotheses = share(recovery.hypotheses), .refined = share(recovery.refined), .searched = 1};
}

/// Returns how far a landmark may have moved against the rest of its model since something hides
/// it, in metres.
double sigma_behind(double seconds) {
  constexpr double kAtOnce = 0.005, kPerSecond = 0.1, kMost = 0.08;
  return std::min(kAtOnce + kPerSecond * std::max(seconds, 0.0), kMost);
}

/// Returns the status of a frame from those of its models.
Status worst(const std::vector<Status>& models) {
  if (std::ranges::all_of(models, [](Status s) { return s == Status::absent; }))
    return Status::absent;
  Status out = Status::tracked;
  for (const Status s : models) out = std::max(out, std::min(s, Status::lost));
  return out;
}

/// Returns whether pictures are searched for a lost model that a start would see: in the first
/// frame and the 4th, 16th, 64th, ...
bool is_time_to_search(unsigned frames) {
  return std::has_single_bit(frames + 1) && std::countr_zero(frames + 1) % 2 == 0;
}

/// Calls a function and names the frame in what it throws, and if it crashes.
template <class Function>
void naming(const Frame& frame, const Function& function) {
  const detail::RunningFrame running(frame.index);
  try {
    function();
  } catch (...) {
    detail::rethrow_from(fmt::format("frame {}", frame.index));
  }
}

/// Subtracts the evaluations of fixed-lag smoothing from a search's budget. Throws ConfigError if
/// less than half would be left.
void reserve_for(const FixedLagSettings& settings, Budget& budget) {
  if (budget.evaluations < 2 * settings.evaluations)
    throw ConfigError(fmt::format(
        "fixed-lag smoothing takes {} evaluations of a frame's budget, which is {}; give "
        "budget.evaluations {} or more, smoothing.fixed_lag.evaluations {} or less, or leave "
        "smoothing.fixed_lag.enabled off",
        settings.evaluations, budget.evaluations, 2 * settings.evaluations,
        budget.evaluations / 2));
  budget.evaluations -= settings.evaluations;
}

/// Subtracts the evaluations of sigmas from a search's budget. Throws ConfigError if less than half
/// would be left.
void reserve_for(const PoseUncertainty& uncertainty, Budget& budget) {
  const std::int64_t needed = uncertainty.evaluations();
  if (budget.evaluations < 2 * needed)
    throw ConfigError(fmt::format(
        "tracker.uncertainty takes {} evaluations of a frame's budget, which is {}; give "
        "budget.evaluations {} or more, or leave tracker.uncertainty.enabled off",
        needed, budget.evaluations, 2 * needed));
  budget.evaluations -= needed;
}

}  // namespace

SceneTracker::SceneTracker(const Scene& scene, TrackerParts parts, Eigen::VectorXd start,
                           std::uint64_t seed)
    : scene_(scene),
      terms_(parts.objective),
      settings_(of_pictures(parts.status, parts.objective)),
      given_(scene, std::move(start), !parts.begins_by_looking),
      departure_(scene, parts.cameras),
      finder_(scene, parts, settings_),
      predictor_(scene, parts.search.prediction),
      smoother_(scene, parts.one_euro),
      smoothing_(parts.one_euro.enabled),
      seed_(seed) {
  if (settings_.check_pictures && look_at_pictures(terms_)) {
    picture_checks_.emplace(parts.cameras, joined_use(terms_).depth);
    rig_ = RigWatch::make(parts.cameras);
    if (rig_) model_rows_.emplace(scene);
  }
  if (parts.begins_by_looking && !recovers())
    throw ConfigError(
        "init.from looks for the models in the pictures, which takes tracker.recovery.enabled, "
        "tracker.evidence and an objective that compares pictures; give a start, for example "
        "`init: {pose: ...}`");
  if (parts.begins_by_looking && parts.cameras.size() < 2)
    throw ConfigError(
        "init.from looks for the models in two views, and the source has one; give a start, for "
        "example `init: {pose: ...}`");
  Eigen::Index landmarks = 0;
  for (const Scene::Item& item : scene.items()) {
    models_.emplace_back(parts.status, landmarks, std::ssize(item.model->data().landmarks));
    if (parts.begins_by_looking) models_.back().monitor.expect_no_start();
    landmarks += models_.back().landmarks;
  }
  state_ = kept_ = together_ = output_ = given_.state();
  if (parts.fixed_lag.enabled) reserve_for(parts.fixed_lag, finder_.budget());
  if (settings_.uncertainty.enabled)
    reserve_for(uncertainty_.emplace(scene, settings_.uncertainty), finder_.budget());
}

SceneTracker::~SceneTracker() { end_job(); }

std::string SceneTracker::backend() const { return finder_.search().cost().backend(); }

Observation SceneTracker::seen(const Frame& frame) const {
  return finder_.search().seen(steadied(frame));
}

Solution SceneTracker::track(const Frame& frame, SearchRecord* record, FrameTrace* trace) {
  Solution solution;
  solution.frame = frame.index;
  solution.time = frame.time;
  solution.cost = kUnknown;
  solution.fault = frame.fault;
  solution.models.assign(models_.size(), Status::missing);
  solution.probabilities.assign(models_.size(), kUnknown);
  if (uncertainty_) solution.sigma.setConstant(std::ssize(scene_.landmark_names()), kUnknown);
  if (!frame.views.empty()) {
    const auto begin = std::chrono::steady_clock::now();
    const auto [fault, view] = fault_of(frame);
    solution.fault = fault;
    solution.fault_view = view;
    if (picture_checks_) brightness_.next(picture_checks_->jumps());
    if (!spoils_pictures(fault)) {
      const Frame steady = steadied(frame);
      naming(steady, [&] { find_or_leave_device(steady, solution, record, trace); });
      if (rig_) doubt_rig(steady, solution);
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    solution.seconds = elapsed.count();
  }
  naming(frame, [&] {
    solution.state = smoothed(solution);
    solution.landmarks = scene_.landmarks(solution.state);
  });
  return solution;
}

Frame SceneTracker::steadied(const Frame& frame) const {
  const Frame steady = brightness_.applied_to(frame);
  return rig_ ? rig_->applied_to(steady) : steady;
}

void SceneTracker::doubt_rig(const Frame& frame, Solution& solution) {
  if (finder_.search().photometric().knows())
    rig_->look_at_colors(solution.frame, finder_.search().second_view_colors());
  if (solution.status == Status::tracked) {
    const FrameSearch& search = finder_.search();
    if (const auto motion = model_rows_->next(frame, search.tiles(), search.drawn(state_)))
      rig_->look_at_motion(solution.frame, *motion);
  } else {
    model_rows_->skip();
  }
  if (!rig_->is_doubtful()) return;
  for (Status& status : solution.models)
    if (status == Status::tracked) status = Status::uncertain;
  solution.status = worst(solution.models);
}

ViewFault SceneTracker::fault_of(const Frame& frame) {
  const ViewFault found = picture_checks_ ? picture_checks_->check(frame) : ViewFault{};
  if (rig_ && !spoils_pictures(found.fault)) rig_->look(frame);
  return found.fault == FrameFault::none ? ViewFault{frame.fault} : found;
}

void SceneTracker::find_or_leave_device(const Frame& frame, Solution& solution,
                                        SearchRecord* record, FrameTrace* trace) {
  const Solution before = solution;
  try {
    return find(frame, solution, record, trace);
  } catch (const DeviceError& error) {
    finder_.search().leave_device(error);
  }
  solution = before;
  if (record) *record = SearchRecord();
  if (trace) *trace = FrameTrace();
  find(frame, solution, record, trace);
}

void SceneTracker::find(const Frame& frame, Solution& solution, SearchRecord* record,
                        FrameTrace* trace) {
  if (job_.valid()) return wait_for_job(frame, solution);
  if (picture_checks_) finder_.search().follow_brightness(picture_checks_->drifts());
  finder_.search().record(record ? &record->searches : nullptr);
  finder_.search().trace(trace, trace ? &frame : nullptr);
  Candidate best = follow(frame);
  const bool answered = complete(frame, best);
  if (answered && trace && best.answers()) compare_with_truth(best, *trace);
  if (!job_.valid()) unwatch();
  if (!answered) return stay_lost(frame, solution);
  conclude(frame, best, solution);
  if (record && best.answers()) describe(frame, best, *record);
}

void SceneTracker::unwatch() {
  finder_.search().record(nullptr);
  finder_.search().trace(nullptr, nullptr);
}

void SceneTracker::compare_with_truth(const Candidate& best, FrameTrace& trace) {
  FrameSearch& search = finder_.search();
  search.show(best.shown);
  trace.cost = search.costs(best.found.state)[0];
  trace.truth_cost = search.truth_cost();
}

void SceneTracker::describe(const Frame& frame, const Candidate& best, SearchRecord& record) {
  FrameSearch& search = finder_.search();
  search.show(best.shown);
  record.state = search.drawn(best.found.state);
  record.observation = search.prepared(frame);
  record.observation.scene = &scene_;
  draw_maps(scene_, terms_, record);
}

Candidate SceneTracker::follow(const Frame& frame) {
  const std::uint64_t seed = frame_seed(seed_, frame.index);
  if (!found_any_ && given_.expects_any()) {
    const bool several = recovers() && begun_ < kPatientFrames;
    Candidate best =
        finder_.begin(frame, given_.state(), several ? settings_.recovery.first_starts : 1, seed);
    ++begun_;
    return best;
  }
  const ModelFlags models = followed();
  if (!any(models)) {
    return {.probabilities = ModelProbabilities(models.size(), kUnknown),
            .shown = models,
            .in_view = ModelFlags(models.size(), true),
            .confirmed = ModelFlags(models.size(), false),
            .reproduced = ModelFlags(models.size(), false),
            .unseen = std::vector<double>(models.size(), kInfinite)};
  }
  finder_.search().show(models);
  Budget budget = finder_.budget();
  budget.usual_cost = models_.front().monitor.usual_cost();
  std::optional<Reach> reach;
  if (recovers()) reach = reach_within(settings_.motion, frame.time - time_);
  Candidate best = finder_.follow(frame, possible_starts(frame.time), models, budget, reach, seed);
  // The models may still come to the start that was given.
  if (recovers() && given_.expects_any() && !finder_.verifier().experienced() &&
      best.probability() < settings_.uncertain_above) {
    const bool several = begun_++ % kSeveralAgain == 0;
    if (finder_.begin_again(frame, given_.state(), several ? settings_.recovery.first_starts : 1,
                            seed_of_part(seed, 9), best)) {
      predictor_.begin_anew();
      smoother_.begin_anew();
    }
  }
  return best;
}

RecoveryRequest SceneTracker::recovery_request(const Frame& frame, const Candidate& best) {
  const ModelFlags none(models_.size(), false);
  RecoveryRequest out{.kept = kept_, .together = together_, .sought = none, .thorough = none};
  ModelFlags confirmed = out.sought, doubtful = out.sought;
  constexpr double kDoubt = 0.8;  // probability
  bool doubts = false;
  for (std::size_t m = 0; m < models_.size(); ++m) {
    ModelTrack& model = models_[m];
    const double p = best.probabilities[m];
    out.seconds.push_back(looks_for(m) ? kInfinite : std::max(frame.time - model.kept_time, 1e-3));
    out.unseen.push_back(frame.time - model.seen_time);
    out.needed.push_back(model.monitor.needed());
    if (awaits(m)) continue;
    if (looks_for(m)) out.together.resize(0);
    out.sought[m] = !best.answers() || !best.shown[m] || p < out.needed[m];
    // A doubtful first pose may prove right: look elsewhere ever less often.
    if (looks_for(m) && out.sought[m] && p >= settings_.uncertain_above)
      out.sought[m] = std::has_single_bit(++looked_);
    out.lost = out.lost || out.sought[m];
    if (out.sought[m]) out.thorough[m] = is_time_to_search(model.sought++);
    confirmed[m] = model.confirmations > 0;
    doubtful[m] = p < kDoubt;
    doubts = doubts || doubtful[m];
  }
  if (out.lost) return out;
  if (settings_.recovery.check > 0 && frame.time - checked_ >= settings_.recovery.check) {
    checked_ = frame.time;
    const std::size_t model = checks_++ % models_.size();
    out.contradicts = out.sought[model] = finder_.recognizes(model);
    if (out.contradicts) return out;
  }
  // Search alternatives around an acceptable but doubtful pose, ever less often while there are
  // none.
  out.near_only = true;
  out.effort = nearby_effort(settings_.recovery);
  doubts_ = doubts ? doubts_ + 1 : doubts_ / 2;
  out.sought = doubts && std::has_single_bit(doubts_) ? doubtful : confirmed;
  return out;
}

bool SceneTracker::complete(const Frame& frame, Candidate& best) {
  if (!recovers() || (best.answers() && std::isnan(best.probability()))) return true;
  test_given_start(frame, best);
  const RecoveryRequest request = recovery_request(frame, best);
  if (!any(request.sought)) return true;
  if (settings_.recovery.run == RecoveryRun::background && !request.contradicts) {
    if (!request.lost) return true;
    bool follows_some = false;
    for (std::size_t m = 0; m < models_.size(); ++m)
      follows_some = follows_some || (best.answers() && best.shown[m] && !request.sought[m]);
    if (!follows_some) {
      start_job(frame, request, best);
      return false;
    }
  }
  const std::uint64_t seed = frame_seed(seed_, frame.index);
  finder_.recover(frame, request, best, seed_of_part(seed, 7));
  if (request.contradicts) doubt_contradicted(request.sought, best);
  // From here on it is as if this pose had been given as the start.
  if (!given_.expects_any() && !finder_.verifier().experienced() &&
      std::ranges::find(best.shown, false) == best.shown.end() &&
      best.probability() >= settings_.uncertain_above && !best.is_sure() && !is_agreed(best))
    finder_.begin_again(frame, best.found.state, settings_.recovery.first_starts,
                        seed_of_part(seed, 8), best);
  return true;
}

bool SceneTracker::is_agreed(const Candidate& best) const {
  for (std::size_t m = 0; m < models_.size(); ++m)
    if (!(best.unseen[m] <= 0 && best.probabilities[m] >= settings_.tracked_above)) return false;
  return true;
}

void SceneTracker::doubt_contradicted(const ModelFlags& checked, Candidate& best) {
  constexpr int kMost = 2;
  for (std::size_t m = 0; m < models_.size(); ++m) {
    if (!checked[m]) continue;
    int& contradictions = models_[m].contradictions;
    contradictions = finder_.contradicted() ? contradictions + 1 : 0;
    if (contradictions < kMost || given_.expects(m)) continue;
    contradictions = 0;
    finder_.forget(m);
    drop(m, best);
  }
}

void SceneTracker::drop(std::size_t model, Candidate& best) const {
  best.shown[model] = false;
  best.probabilities[model] = 0;
  best.unseen[model] = kInfinite;
  if (!any(best.shown)) best.found.cost = kInfinite;
}

void SceneTracker::leave_start(std::size_t model, const std::string& why) {
  given_.contradict(model, why);
  models_[model].monitor.distrust_start();
}

void SceneTracker::test_given_start(const Frame& frame, Candidate& best) {
  for (std::size_t m = 0; m < models_.size(); ++m) {
    if (!awaits(m) || !best.answers() || !best.shown[m]) continue;
    const std::optional<double> apart = finder_.seen_from(frame, m, best.found.state);
    if (apart && *apart > kElsewhere) {
      leave_start(m,
                  fmt::format("a detector sees it {:.0f} mm (mean over the landmarks) from where "
                              "the search from the start ended",
                              1000 * *apart));
      drop(m, best);
    } else if (apart && *apart < kHere) {
      best.unseen[m] = 0;
    } else if (is_doubtful(best, m)) {
      try_other_poses(frame, m, best);
    }
  }
}

bool SceneTracker::is_doubtful(const Candidate& best, std::size_t model) const {
  return best.from_start && !best.reproduced[model] &&
         best.probabilities[model] >= settings_.uncertain_above &&
         given_.is_left(model, best.found.state);
}

void SceneTracker::try_other_poses(const Frame& frame, std::size_t model, Candidate& best) {
  constexpr double kAgo = 1;  // seconds since the models were as the start has them
  // As much as some of the searches from the start, which it follows.
  constexpr GlobalSearchSettings kEffort{.hypotheses = 200, .refined = 12};
  const std::size_t count = models_.size();
  best.probabilities[model] = given_.doubted(best.probabilities[model]);
  RecoveryRequest request{.kept = given_.state(),
                          .together = {},
                          .seconds = std::vector<double>(count, kAgo),
                          .unseen = std::vector<double>(count, kInfinite),
                          .sought = ModelFlags(count, false),
                          .thorough = ModelFlags(count, false),
                          .near_only = true,
                          .effort = kEffort};
  request.sought[model] = true;
  for (const ModelTrack& one : models_) request.needed.push_back(one.monitor.needed());
  const auto part = static_cast<std::uint32_t>(200 + model);
  finder_.recover(frame, request, best, seed_of_part(frame_seed(seed_, frame.index), part));
  const std::string why = "searches from around it end in different poses";
  given_.doubt(model, why);
  if (!(best.probabilities[model] >= settings_.surely_above)) leave_start(model, why);
}

void SceneTracker::start_job(const Frame& frame, const RecoveryRequest& request,
                             const Candidate& best) {
  // The source may reuse its images.
  Frame copy = frame;
  for (View& view : copy.views) {
    view.color = view.color.clone();
    view.mask = view.mask.clone();
    view.depth = view.depth.clone();
  }
  unwatch();
  const std::uint64_t seed = seed_of_part(frame_seed(seed_, frame.index), 7);
  job_unwanted_ = false;
  job_ = std::async(std::launch::async,
                    [this, copy = std::move(copy), request, seed, from = best]() mutable {
                      const StopTest unwanted = [this] { return job_unwanted_.load(); };
                      const StopScope scope(unwanted);
                      finder_.recover(copy, request, from, seed);
                      return from;
                    });
}

void SceneTracker::end_job() {
  if (!job_.valid()) return;
  job_unwanted_ = true;
  job_.wait();
  job_ = {};
}

void SceneTracker::wait_for_job(const Frame& frame, Solution& solution) {
  if (job_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return stay_lost(frame, solution);
  Candidate best = job_.get();
  if (best.answers() && best.probability() >= kLeastPromising) {
    // The job searched an earlier frame: search this one from its result.
    const std::uint64_t seed = frame_seed(seed_, frame.index);
    best = finder_.go_on(frame, best, seed);
    RecoveryRequest request = recovery_request(frame, best);
    request.near_only = true;
    if (request.lost) finder_.recover(frame, request, best, seed_of_part(seed, 7));
  } else {
    best.found.cost = kInfinite;
  }
  conclude(frame, best, solution);
}

void SceneTracker::stay_lost(const Frame& frame, Solution& solution) {
  for (std::size_t m = 0; m < models_.size(); ++m) {
    solution.models[m] = models_[m].status = models_[m].monitor.judge(
        {.cost = kInfinite, .in_view = !departure_.is_gone(m, frame.time)});
    extrapolate(m, frame.time, state_);
    given_.conclude(frame.index, m, state_, false);
  }
  solution.status = Status::lost;
  widen(frame, solution);
}

void SceneTracker::conclude(const Frame& frame, const Candidate& best, Solution& solution) {
  const ModelFlags followed_before = followed();
  judge_models(frame, best, solution);
  ModelFlags tracked, good;
  for (const ModelTrack& model : models_) {
    tracked.push_back(model.status == Status::tracked);
    good.push_back(tracked.back() || model.status == Status::uncertain);
  }
  doubt_hidden(frame, best, solution);
  const bool any_good = any(good);
  // Without recovery, tracking continues from any pose in view, as in the paper. With it, this
  // holds for models that were never surely found.
  if (best.answers() && finder_.search().tiles().visible_share(best.found.state) > 0)
    for (std::size_t m = 0; m < models_.size(); ++m) {
      const bool never_found = awaits(m) && (begun_ >= kPatientFrames || any_good);
      good[m] = good[m] || (best.shown[m] && (!recovers() || never_found));
    }
  go_on_from(frame, best, good);
  if (best.answers() && any(good))
    finder_.search().remember(std::make_shared<PreviousSolution>(PreviousSolution{
                                  frame.index, frame.time, best.found.cost, best.found.state, {}}),
                              &frame);
  finder_.accept(frame, best, tracked);
  keep(frame, best, tracked);
  // A model that comes back did not move there continuously.
  if (!any_good || good != followed_before) {
    predictor_.forget_motion();
    smoother_.begin_anew();
  }
  if (recovers()) widen(frame, solution);
}

void SceneTracker::judge_models(const Frame& frame, const Candidate& best, Solution& solution) {
  solution.cost = best.found.cost;
  solution.evaluations = best.found.evaluations;
  solution.probabilities = best.probabilities;
  FrameSearch& search = finder_.search();
  StatusEvidence evidence{.cost = best.found.cost, .sigma = kUnknown};
  if (best.answers()) {
    search.show(best.shown);
    const Eigen::VectorXd drawn = search.drawn(best.found.state);
    evidence.visible = search.tiles().visible_share(best.found.state);
    evidence.foreground_overlap = search.tiles().foreground_overlap(frame, drawn);
    if (uncertainty_) {
      solution.sigma = uncertainty_->of(search.cost(), drawn);
      solution.evaluations += uncertainty_->evaluations();
    }
  }
  for (std::size_t m = 0; m < models_.size(); ++m) {
    StatusEvidence own = evidence;
    if (!best.shown[m]) own.cost = kInfinite;
    own.probability = best.probabilities[m];
    if (solution.sigma.size() > 0 && models_[m].landmarks > 0)
      own.sigma = models_[m].part_of(solution.sigma).mean();
    own.recognized = best.is_recognized(m);
    // What has left the pictures takes more evidence to be back.
    const bool is_back = own.probability >= settings_.confirmed_above || own.recognized;
    const bool is_found = best.answers() && best.shown[m] && is_back;
    const bool is_gone = recovers() && !is_found && departure_.is_gone(m, frame.time);
    own.in_view = best.in_view[m] && !is_gone;
    // A detector that sees the model there confirms it as another search does.
    own.confirmed = best.confirmed[m] || best.unseen[m] <= 0;
    if (best.unseen[m] <= 0) models_[m].seen_time = frame.time;
    const Status status = models_[m].status = models_[m].monitor.judge(own);
    given_.conclude(frame.index, m, best.found.state, status == Status::tracked);
    solution.models[m] = status;
  }
  solution.status = worst(solution.models);
}

void SceneTracker::doubt_hidden(const Frame& frame, const Candidate& best, Solution& solution) {
  if (seen_.size() == 0) seen_.setConstant(std::ssize(scene_.landmark_names()), frame.time);
  if (best.answers()) solution.hidden = finder_.hidden(best.found.state);
  for (std::size_t m = 0; m < models_.size(); ++m) {
    const ModelTrack& model = models_[m];
    double sum = 0;
    for (Eigen::Index i = model.first_landmark; i < model.first_landmark + model.landmarks; ++i) {
      if (solution.hidden.empty() || !solution.hidden[static_cast<std::size_t>(i)]) {
        if (model.status == Status::tracked) seen_[i] = frame.time;
        continue;
      }
      const double sigma = sigma_behind(frame.time - seen_[i]);
      sum += sigma;
      if (solution.sigma.size() > 0) solution.sigma[i] = std::max(solution.sigma[i], sigma);
    }
    // The search goes on from it: the part that pictures show is right.
    if (model.status == Status::tracked &&
        sum > settings_.uncertain_sigma * static_cast<double>(model.landmarks))
      solution.models[m] = Status::uncertain;
  }
  solution.status = worst(solution.models);
}

ModelFlags SceneTracker::followed() const {
  ModelFlags out;
  for (std::size_t m = 0; m < models_.size(); ++m)
    out.push_back(found_any_ && (!recovers() || models_[m].is_followed() || awaits(m)));
  return out;
}

Eigen::MatrixXd SceneTracker::possible_starts(double time) {
  const Eigen::MatrixXd states = predictor_.at(time);
  // A tile needs a start that is in view.
  if (states.cols() == 0 || finder_.search().tiles().visible_share(states.col(0)) == 0)
    return state_;
  return states.cols() < finder_.budget().evaluations ? states : states.leftCols(1);
}

void SceneTracker::go_on_from(const Frame& frame, const Candidate& best, const ModelFlags& good) {
  for (std::size_t m = 0; m < models_.size(); ++m) {
    const Scene::Item& item = scene_.items()[m];
    const Eigen::Index size = item.model->dimension();
    if (good[m])
      state_.segment(item.offset, size) = best.found.state.segment(item.offset, size);
    else if (recovers())
      extrapolate(m, frame.time, state_);
  }
  if (recovers() && finder_.search().tiles().visible_share(state_) == 0) state_ = kept_;
  if (!any(good)) return;
  departure_.remember(state_, frame.time, good);
  time_ = frame.time;
  found_any_ = true;
  predictor_.add(state_, frame.time);
}

void SceneTracker::keep(const Frame& frame, const Candidate& best, const ModelFlags& tracked) {
  Eigen::Index first = 0;
  for (std::size_t m = 0; m < models_.size(); ++m) {
    ModelTrack& model = models_[m];
    const Scene::Item& item = scene_.items()[m];
    const Eigen::Index size = item.model->dimension();
    model.confirmations = tracked[m] ? std::max(0, model.confirmations - 1) : kConfirmations;
    if (tracked[m]) {
      model.sought = 0;
      kept_.segment(item.offset, size) = best.found.state.segment(item.offset, size);
      model.kept_time = frame.time;
      const auto& velocity = predictor_.velocity();
      model.velocity = velocity ? velocity->segment(first, size - 1) : Eigen::VectorXd();
    }
    first += size - 1;
  }
  if (std::ranges::find(tracked, false) == tracked.end()) together_ = kept_;
}

void SceneTracker::extrapolate(std::size_t model, double time, Eigen::VectorXd& state) const {
  constexpr double kSlowing = 0.1;  // time constant, in seconds, with which unseen motion fades
  const ModelTrack& track = models_[model];
  const Scene::Item& item = scene_.items()[model];
  const Eigen::Index size = item.model->dimension();
  Eigen::VectorXd from = state;
  from.segment(item.offset, size) = kept_.segment(item.offset, size);
  state.segment(item.offset, size) = kept_.segment(item.offset, size);
  if (track.velocity.size() == 0) return;
  const double seconds =
      kSlowing * (1 - std::exp(-std::max(time - track.kept_time, 0.0) / kSlowing));
  const auto before = static_cast<Eigen::Index>(model);  // a difference is shorter by one per model
  Eigen::VectorXd motion =
      Eigen::VectorXd::Zero(scene_.dimension() - static_cast<Eigen::Index>(scene_.items().size()));
  motion.segment(item.offset - before, size - 1) = track.velocity * seconds;
  state.segment(item.offset, size) = moved(scene_, from, motion).segment(item.offset, size);
}

void SceneTracker::widen(const Frame& frame, Solution& solution) const {
  if (solution.sigma.size() == 0) return;
  for (const ModelTrack& model : models_) {
    if (model.is_followed()) continue;
    const double wider = sigma_after(frame.time - model.kept_time);
    for (double& sigma : model.part_of(solution.sigma))
      if (!(sigma > wider)) sigma = wider;
  }
}

Eigen::VectorXd SceneTracker::smoothed(const Solution& solution) {
  if (!smoothing_) return state_;
  if (solution.status != Status::missing) output_ = smoother_.filter(state_, solution.time);
  return output_;
}

void SceneTracker::search_anew() {
  end_job();
  for (std::size_t m = 0; m < models_.size(); ++m) {
    ModelTrack& model = models_[m];
    model.status = Status::lost;
    model.sought = 0;
    model.confirmations = kConfirmations;
    model.contradictions = 0;
    model.velocity.resize(0);
    if (!given_.expects(m)) finder_.forget(m);
  }
  if (!recovers()) found_any_ = false;
  looked_ = doubts_ = 0;
  departure_.forget();
  finder_.search().remember(nullptr);
  predictor_.begin_anew();
  smoother_.begin_anew();
}

void SceneTracker::check(const Frame& frame) {
  naming(frame, [&] {
    finder_.search().take_in(finder_.search().tiles(), frame,
                             finder_.search().tiles().plan(frame, state_));
  });
}

std::string SceneTracker::problem_of_start(const Frame& frame) const {
  constexpr const char* kQuestion =
      "is the start (init) where the models are, and do the cameras and their units (calibration) "
      "belong to the pictures?";
  if (!given_.expects_any()) return {};
  const double visible = finder_.search().tiles().visible_share(state_);
  if (visible < settings_.min_visible)
    return fmt::format(
        "{:.0f} % of what the models cover at the start is inside every image, and a frame with "
        "less than {:.0f} % counts as lost (tracker.min_visible); {}",
        100 * visible, 100 * settings_.min_visible, kQuestion);
  const ForegroundOverlap foreground_overlap =
      finder_.search().tiles().foreground_overlap(frame, state_);
  if (foreground_overlap == ForegroundOverlap::nowhere)
    return fmt::format(
        "the models at the start cover no foreground pixel of any mask, and such a frame counts as "
        "lost; {}",
        kQuestion);
  if (foreground_overlap == ForegroundOverlap::in_parts)
    return fmt::format(
        "no point of the models at the start is on the foreground of all masks, and such a frame "
        "counts as uncertain; {}",
        kQuestion);
  return {};
}

}  // namespace hypotrack::internal
