#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "contour_views.hpp"
#include "correspondence_lines.hpp"
#include "hypotrack/observation.hpp"

namespace hypotrack::contour {

/// Returns the lines of a model in a view, of the outline that the camera sees.
std::vector<CorrespondenceLine> lines_of(const ContourViews& model,
                                         const Eigen::Isometry3d& world_from_model,
                                         const RegionView& view, int scale);

/// Moves a model to where the correspondence lines of all views say, from coarse to fine segments:
/// Gauss-Newton steps on the lines' means and variances, with a prior on each step (SRT3D, sections
/// 3.4 and 3.5). Returns the pose it was given where too few lines are seen.
Eigen::Isometry3d fit_region(const ContourViews& model, Eigen::Isometry3d world_from_model,
                             const std::vector<RegionView>& views);

}  // namespace hypotrack::contour
