#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "hypotrack/export.hpp"
#include "lab/report/study_data.hpp"

namespace hypotrack {

/// What the page draws for a study, as plain data that plots.js turns into Vega specifications: a
/// list of objects
///   {id, kind, title, note, x: {label, values, numeric}, y: {label, ...}, color: {...} or null,
///    facets: [{label, rows: [{x, y, color, mean, sd, n}, ...]}, ...]}
/// where each row is the mean over the runs that share its place. Plots that the study asks for, or
/// a default choice by its axes. Throws DataError on a request for something that there is not.
HYPOTRACK_API nlohmann::ordered_json plot_data(const StudyData& study);

/// The plots that are made for a study that asks for none.
HYPOTRACK_API std::vector<PlotRequest> default_plots(const StudyData& study);

}  // namespace hypotrack
