#pragma once

#include <filesystem>
#include <vector>

#include "base/exported.hpp"
#include "lab/report/trace/profiles.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// What a convergence is drawn over: a column of trace.csv.
enum class TraceCost { evaluations, cpu_seconds, wall_seconds };

/// A step down of the cost in a frame.
struct CurveStep {
  double spent = 0;   ///< in the frame so far
  double cost = 0;    ///< lowest so far
  double excess = 0;  ///< lowest so far of (cost - truth) / |truth|; NaN: the truth is unknown
};

/// The convergence of a frame: its searches one after the other.
struct FrameCurve {
  int frame = 0;
  int dimension = 0;  ///< of the first search
  std::vector<CurveStep> steps = {};
  double spent = 0;  ///< in all

  /// Returns the last step within `budget`; null: there is none yet.
  const CurveStep* at(double budget) const;
  /// Returns the search for a cost of at most truth + tolerance * |truth|.
  Trial towards(double tolerance) const;
};

/// Reads the convergence of every frame from a trace.csv. Keeps only steps at which the cost fell.
/// Throws DataError on missing and damaged files.
std::vector<FrameCurve> read_curves(const std::filesystem::path& file, TraceCost over);

}  // namespace internal
}  // namespace hypotrack
