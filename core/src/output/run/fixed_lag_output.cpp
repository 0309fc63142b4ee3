#include "output/run/fixed_lag_output.hpp"

#include <utility>

namespace hypotrack::internal {

void FixedLagOutput::add(const SceneTracker& tracker, const Frame& frame,
                         const Solution& solution) {
  if (!smoother_) {
    output_->add(frame, solution);
    return;
  }
  output_->add_online(frame, solution);
  Frame kept = frame;
  kept.views.clear();
  waiting_.push_back({std::move(kept), solution});
  const bool seen = solution.status == Status::tracked || solution.status == Status::uncertain;
  smoother_->add(seen ? FrameTiles(tracker.seen(frame)) : FrameTiles(),
                 {frame.time, solution.state});
  write(smoother_->take());
}

void FixedLagOutput::write(const std::vector<FixedLagSmoother::Settled>& settled) {
  for (const FixedLagSmoother::Settled& one : settled) {
    Waiting frame = std::move(waiting_.front());
    waiting_.pop_front();  // an output that throws does not get the frame again
    frame.solution.state = one.state;
    frame.solution.landmarks = scene_->landmarks(one.state);
    frame.solution.evaluations += one.evaluations;
    output_->add(std::move(frame.frame), std::move(frame.solution));
  }
}

void FixedLagOutput::finish() {
  if (smoother_) write(smoother_->finish());
}

void FixedLagOutput::finish_unchanged() {
  while (!waiting_.empty()) {
    Waiting frame = std::move(waiting_.front());
    waiting_.pop_front();
    output_->add(std::move(frame.frame), std::move(frame.solution));
  }
}

}  // namespace hypotrack::internal
