#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "base/exported.hpp"
#include "lab/report/study_data.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the plots of a study as plain data, which plots.js turns into Vega specifications: a
/// list of objects
///
///   {id, kind, title, note, x: {label, values, numeric}, y: {label, ...}, color: {...} or null,
///    facets: [{label, rows: [{x, y, color, mean, sd, n}, ...]}, ...]}
///
/// Each row is the mean over the runs with the same x, y and color. Plots of how searches converge
/// are those of traced_plot(). Without plots in the study it uses default_plots(). Throws DataError
/// if a plot asks for something that does not exist.
nlohmann::ordered_json plot_data(const StudyData& study);

/// Returns the plots of a study that asks for none.
std::vector<PlotRequest> default_plots(const StudyData& study);

}  // namespace internal
}  // namespace hypotrack
