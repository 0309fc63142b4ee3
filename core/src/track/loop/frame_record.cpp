#include "track/loop/frame_record.hpp"

namespace hypotrack::internal {

FrameRecord::FrameRecord(const Scene& scene, FrameSearch& search, const Frame& frame,
                         SearchRecord* record, FrameTrace* trace)
    : scene_(scene), search_(search), frame_(frame), record_(record), trace_(trace) {
  search_.record(record ? &record->searches : nullptr);
  search_.trace(trace, trace ? &frame : nullptr);
}

void FrameRecord::end(const Candidate& best) {
  if (trace_ && best.answers()) {
    search_.show(best.shown);
    trace_->cost = search_.costs(best.found.state)[0];
    trace_->truth_cost = search_.truth_cost();
  }
  end();
}

void FrameRecord::end() {
  search_.record(nullptr);
  search_.trace(nullptr, nullptr);
}

void FrameRecord::describe(const Candidate& best, const std::vector<ObjectiveTerm>& terms) {
  if (!record_ || !best.answers()) return;
  search_.show(best.shown);
  record_->state = search_.drawn(best.found.state);
  record_->observation = search_.prepared(frame_);
  record_->observation.scene = &scene_;
  draw_maps(scene_, terms, *record_);
}

}  // namespace hypotrack::internal
