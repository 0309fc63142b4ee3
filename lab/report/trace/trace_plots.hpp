#pragma once

#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "lab/report/plots/plot_parts.hpp"
#include "lab/report/study_data.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns whether plots of a kind are made from trace.csv.
bool is_traced(std::string_view kind);

/// Returns whether a run wrote trace.csv.
bool has_trace(const StudyRun& run);

/// Makes a plot of how searches converge, over the frames and seeds of all traced runs. The kinds
/// of plots are:
///
///   convergence            median and quartiles of the lowest cost
///   targets                share of frames in which a target was reached (share_within())
///   performance_profile    share of frames within a factor of the fastest (performance_ratios())
///   data_profile           share of frames over simplex gradients (simplex_gradients())
///   expected_running_time  expected_running_time() over the targets
///
/// A target is the cost at the truth plus one of StudyData::tolerances times its magnitude. `color`
/// is the axis of what is compared, and a problem a frame of a run with all else equal. The result
/// is that of plot_data(); rows are {color, x, mean, lo, hi, n}. Throws DataError on a damaged
/// trace.csv.
nlohmann::ordered_json traced_plot(const StudyData& study, const PlotRequest& request,
                                   const Runs& runs);

}  // namespace internal
}  // namespace hypotrack
