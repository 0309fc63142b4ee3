#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/text_file.hpp"
#include "hypotrack/scene.hpp"
#include "output/metrics/reliability.hpp"
#include "output/run_directory.hpp"
#include "track/tracker.hpp"

namespace hypotrack {

/// What a tracker says of its own errors, frame by frame: uncertainty.csv, a column per landmark,
/// in millimetres. The file appears with the first frame that has something for it.
class UncertaintyOutput {
 public:
  /// Both must outlive it.
  UncertaintyOutput(const Scene& scene, RunDirectory& directory)
      : scene_(&scene), directory_(&directory) {}

  /// `errors` are the landmarks' in metres, NaN where unknown. Does nothing for a solution without
  /// sigma. Throws OutputError.
  void add(const Solution& solution, const Eigen::VectorXd& errors);

  /// Mean of all sigmas in metres; nothing if there were none.
  std::optional<double> mean_sigma() const;
  /// Of the landmarks with a truth.
  const Reliability& reliability() const { return reliability_; }

 private:
  const Scene* scene_;
  RunDirectory* directory_;
  std::optional<TextFile> file_;
  Reliability reliability_;
  double sum_ = 0;
  std::int64_t count_ = 0;
};

}  // namespace hypotrack
