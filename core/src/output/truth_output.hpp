#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "base/text_file.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/scene.hpp"
#include "output/metrics/landmark_errors.hpp"
#include "output/run_directory.hpp"

namespace hypotrack {

/// What a run knows of the truth, frame by frame: truth_states.csv, truth_landmarks.csv and
/// errors.csv. A file appears with the first frame that has something for it.
class TruthOutput {
 public:
  /// All must outlive it; `layout` is that of the scene's landmarks.
  TruthOutput(const Scene& scene, const LandmarkLayout& layout, RunDirectory& directory)
      : scene_(&scene), layout_(&layout), directory_(&directory) {}

  /// `landmarks` are the frame's true ones; `error`, in metres, and `status` are the solution's.
  /// Throws OutputError.
  void add(const Frame& frame, const Eigen::Matrix3Xd& landmarks, const FrameError& error,
           std::string_view status);

  /// Whether any frame had a truth.
  bool known() const { return errors_.has_value(); }

 private:
  void open();

  const Scene* scene_;
  const LandmarkLayout* layout_;
  RunDirectory* directory_;
  std::optional<TextFile> states_, landmarks_, errors_;
};

}  // namespace hypotrack
