#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "base/exported.hpp"
#include "hypotrack/api/files.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/plugin/output.hpp"
#include "output/metrics/landmark_errors.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Writes the truth of a run frame by frame: truth_states.csv, truth_landmarks.csv and errors.csv.
/// A file appears with the first frame that has data for it.
class TruthOutput {
 public:
  /// Both arguments must outlive the object. `layout` is that of the scene's landmarks.
  TruthOutput(const LandmarkLayout& layout, OutputContext& run) : layout_(&layout), run_(&run) {}

  /// Adds a frame. `landmarks` are its true ones; `error`, in metres, and `status` are the
  /// solution's. Throws OutputError.
  void add(const Frame& frame, const Eigen::Matrix3Xd& landmarks, const FrameError& error,
           std::string_view status);

  /// Returns whether any frame had a truth.
  bool known() const { return errors_.has_value(); }

 private:
  void open();

  const LandmarkLayout* layout_;
  OutputContext* run_;
  std::optional<TextFile> states_, landmarks_, errors_;
};

}  // namespace internal
}  // namespace hypotrack
