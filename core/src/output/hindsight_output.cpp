#include "output/hindsight_output.hpp"

#include <limits>
#include <utility>

namespace hypotrack {

double HindsightOutput::add(const SceneTracker& tracker, const Frame& frame,
                            const Solution& solution) {
  if (!hindsight_) return output_->add(frame, solution);
  output_->add_online(frame, solution);
  Frame kept = frame;
  kept.views.clear();
  waiting_.push_back({std::move(kept), solution});
  const bool seen = solution.status == Status::tracked || solution.status == Status::uncertain;
  hindsight_->add(seen ? Sight(tracker.seen(frame)) : Sight(), {frame.time, solution.state});
  write(hindsight_->take());
  return std::numeric_limits<double>::quiet_NaN();
}

void HindsightOutput::write(const std::vector<Hindsight::Settled>& settled) {
  for (const Hindsight::Settled& one : settled) {
    Waiting& frame = waiting_.front();
    frame.solution.state = one.state;
    frame.solution.landmarks = output_->scene().landmarks(one.state);
    frame.solution.evaluations += one.evaluations;
    output_->add(frame.frame, frame.solution);
    waiting_.pop_front();
  }
}

void HindsightOutput::finish() {
  if (hindsight_) write(hindsight_->finish());
}

void HindsightOutput::finish_unchanged() {
  for (const Waiting& frame : waiting_) output_->add(frame.frame, frame.solution);
  waiting_.clear();
}

}  // namespace hypotrack
