#pragma once

#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/output.hpp"
#include "track/search/candidate_finder.hpp"
#include "track/search/frame_search.hpp"
#include "track/search/optimizer_trace.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Records and traces the searches of a frame for whoever asked for that.
class FrameRecord {
 public:
  /// Begins. `record` and `trace` may be null. All arguments must outlive the object.
  FrameRecord(const Scene& scene, FrameSearch& search, const Frame& frame, SearchRecord* record,
              FrameTrace* trace);

  /// Ends, for later searches are neither recorded nor traced.
  void end();
  /// Ends after the searches. The answer and the truth are evaluated in the tiles of the answer.
  void end(const Candidate& best);
  /// Adds the tiles, the answer drawn in them and the terms' maps of it.
  void describe(const Candidate& best, const std::vector<ObjectiveTerm>& terms);

 private:
  const Scene& scene_;
  FrameSearch& search_;
  const Frame& frame_;
  SearchRecord* record_;
  FrameTrace* trace_;
};

/// Draws the state of a record into the tiles of its observation and adds the depths, and the maps
/// of those terms that have some. Prepares these terms with the observation.
void draw_maps(const Scene& scene, const std::vector<ObjectiveTerm>& terms, SearchRecord& record);

}  // namespace internal
}  // namespace hypotrack
