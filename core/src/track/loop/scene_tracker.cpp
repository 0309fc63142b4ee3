#include "track/loop/scene_tracker.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "base/profile.hpp"
#include "hypotrack/api/error.hpp"
#include "plugin/plugin_call.hpp"
#include "track/faults/picture_checks.hpp"
#include "track/loop/setup.hpp"
#include "track/loop/steps.hpp"

namespace hypotrack::internal {

SceneTracker::SceneTracker(const Scene& scene, TrackerParts parts, Eigen::VectorXd start,
                           std::uint64_t seed)
    : loop_(scene, parts, std::move(start), seed),
      terms_(parts.objective),
      pictures_(parts.cameras, terms_, loop_.settings.check_pictures && look_at_pictures(terms_),
                loop_.settings.correct_turn),
      judge_(loop_),
      arena_(parts.evaluate.threads > 0 ? parts.evaluate.threads : tbb::task_arena::automatic),
      background_(arena_.max_concurrency()) {
  check_looking(parts, loop_.recovers());
  reserve_evaluations(parts.fixed_lag, judge_.evaluations(), loop_.finder.budget());
}

SceneTracker::~SceneTracker() = default;

Solution SceneTracker::track(const Frame& frame, SearchRecord* record, FrameTrace* trace) {
  return arena_.execute([&] { return track_here(frame, record, trace); });
}

Solution SceneTracker::track_here(const Frame& frame, SearchRecord* record, FrameTrace* trace) {
  const ProfiledPart part("frame");
  Solution solution = judge_.unjudged(frame);
  const PictureWatch::FrameEnd end(pictures_);
  if (!frame.views.empty()) {
    const auto begin = std::chrono::steady_clock::now();
    const auto [fault, view] =
        detail::in_frame(frame.index, [&] { return pictures_.check(frame); });
    solution.fault = fault;
    solution.fault_view = view;
    if (!spoils_pictures(fault)) {
      const Frame steady = pictures_.steadied(frame);
      detail::in_frame(steady.index,
                       [&] { find_or_leave_device(steady, solution, record, trace); });
      const bool is_searched = !background_.is_running();
      const bool is_followed = is_searched && solution.status <= Status::uncertain;
      if (pictures_.doubts_depth(steady.index, is_searched)) call_uncertain(solution);
      if (is_followed) pictures_.compare_views(steady.index, loop_.trail.state());
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    solution.seconds = elapsed.count();
  }
  detail::in_frame(frame.index, [&] {
    solution.state = loop_.trail.output(solution);
    solution.landmarks = loop_.scene.landmarks(solution.state);
  });
  return solution;
}

void SceneTracker::find_or_leave_device(const Frame& frame, Solution& solution,
                                        SearchRecord* record, FrameTrace* trace) {
  const Solution before = solution;
  try {
    return find(frame, solution, record, trace);
  } catch (const DeviceError& error) {
    loop_.finder.search().leave_device(error);
  }
  solution = before;
  if (record) *record = SearchRecord();
  if (trace) *trace = FrameTrace();
  find(frame, solution, record, trace);
}

void SceneTracker::find(const Frame& frame, Solution& solution, SearchRecord* record,
                        FrameTrace* trace) {
  if (background_.is_running()) return find_from_background(frame, solution);
  pictures_.tell_drifts(loop_.finder.search());
  FrameRecord watch(loop_.scene, loop_.finder.search(), frame, record, trace);
  Candidate best = follow(loop_, frame);
  if (loop_.can_recover(best)) {
    check_start(loop_, frame, best);
    const RecoveryRequest request = plan_.next(loop_, frame, best);
    if (plan_.is_for_background(loop_, request, best)) {
      watch.end();
      background_.start(frame, [this, request, found = best](const Frame& copy) mutable {
        loop_.finder.recover(copy, request, found, loop_.seed_of(copy, 7));
        return found;
      });
      return stay_lost(frame, solution);
    }
    if (any(request.sought)) recover(loop_, frame, request, best);
  }
  watch.end(best);
  conclude(frame, best, solution);
  watch.describe(best, terms_);
}

void SceneTracker::find_from_background(const Frame& frame, Solution& solution) {
  std::optional<Candidate> best = background_.take();
  if (!best) return stay_lost(frame, solution);
  catch_up(loop_, plan_, frame, *best);
  conclude(frame, *best, solution);
}

void SceneTracker::stay_lost(const Frame& frame, Solution& solution) {
  judge_.judge_without_search(frame, solution);
  accept_nothing(loop_, frame);
}

void SceneTracker::conclude(const Frame& frame, const Candidate& best, Solution& solution) {
  const ModelFlags before = loop_.followed();
  const std::vector<Status> judgement = judge_.judge(frame, best, solution);
  const ModelFlags now = accept(loop_, frame, best, judgement);
  learn(loop_, frame, best, judgement);
  // A model that comes back did not move there continuously.
  const bool is_lost = std::ranges::all_of(judgement, [](Status s) { return s >= Status::lost; });
  if (is_lost || now != before) loop_.trail.interrupt();
  if (loop_.recovers()) judge_.widen(frame, solution);
}

void SceneTracker::search_anew() {
  background_.cancel();
  plan_.restart();
  loop_.restart();
}

void SceneTracker::check(const Frame& frame) {
  detail::in_frame(frame.index, [&] {
    FrameSearch& search = loop_.finder.search();
    search.take_in(search.tiles(), frame, search.tiles().plan(frame, loop_.trail.state()));
  });
}

ViewFault SceneTracker::fault_of(const Frame& frame) {
  return arena_.execute([&] {
    const PictureWatch::FrameEnd end(pictures_);
    return pictures_.check(frame);
  });
}

std::string SceneTracker::problem_of_start(const Frame& frame) const {
  if (!loop_.given.expects_any()) return {};
  return internal::problem_of_start(frame, loop_.trail.state(), loop_.tiles(),
                                    loop_.settings.min_visible);
}

}  // namespace hypotrack::internal
