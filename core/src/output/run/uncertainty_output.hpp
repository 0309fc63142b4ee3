#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/exported.hpp"
#include "hypotrack/api/files.hpp"
#include "hypotrack/api/solution.hpp"
#include "hypotrack/plugin/output.hpp"
#include "output/metrics/reliability.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Writes the predicted uncertainty frame by frame: uncertainty.csv, a column per landmark, in
/// millimetres. The file appears with the first frame that has data for it.
class UncertaintyOutput {
 public:
  /// `run` must outlive the object.
  explicit UncertaintyOutput(OutputContext& run) : run_(&run) {}

  /// Adds a solution; does nothing if it has no sigma. `errors` are the landmarks' in metres, NaN
  /// where unknown. Throws OutputError.
  void add(const Solution& solution, const Eigen::VectorXd& errors);

  /// Returns the mean of all sigmas in metres; nothing if there were none.
  std::optional<double> mean_sigma() const;
  /// Returns the calibration of the sigmas, over landmarks with a truth.
  const Reliability& reliability() const { return reliability_; }

 private:
  OutputContext* run_;
  std::optional<TextFile> file_;
  Reliability reliability_;
  double sum_ = 0;
  std::int64_t count_ = 0;
};

}  // namespace internal
}  // namespace hypotrack
