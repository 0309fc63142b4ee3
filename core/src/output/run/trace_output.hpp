#pragma once

#include <map>
#include <optional>
#include <utility>

#include "base/exported.hpp"
#include "hypotrack/api/files.hpp"
#include "hypotrack/plugin/output.hpp"
#include "output/metrics/frame_outcome.hpp"
#include "track/search/optimizer_trace.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Writes how searches converged: trace.csv, a row per batch of evaluations, and truth_costs.csv, a
/// row per frame with a true state. The files appear with the first frame that has data for them.
class TraceOutput {
 public:
  /// `run` must outlive the object.
  explicit TraceOutput(OutputContext& run) : run_(&run) {}

  /// Adds the searches of a frame. Throws OutputError.
  void add(int frame, const FrameTrace& trace);
  /// Judges a traced frame with a known true state by its error in millimetres. Returns `unknown`
  /// for other frames. Throws OutputError.
  FrameOutcome judge(int frame, double error_mm);

 private:
  OutputContext* run_;
  std::optional<TextFile> file_, costs_file_;
  std::map<int, std::pair<double, double>> costs_;  ///< of answer and truth, of frames to judge
};

}  // namespace internal
}  // namespace hypotrack
