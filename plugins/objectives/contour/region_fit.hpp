#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "contour_views.hpp"
#include "correspondence_lines.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "terms.hpp"

namespace hypotrack::contour {

/// Returns the lines of a model in a view, of the outline that the camera sees.
std::vector<CorrespondenceLine> lines_of(const ContourViews& model,
                                         const Eigen::Isometry3d& world_from_model,
                                         const RegionView& view, int scale);

/// The views that measured depth, and the surface to fit to it.
struct DepthViews {
  std::span<const SurfacePoint> points;
  std::vector<const TileView*> views;
  double sigma = 1;  ///< of measured depth, metres
};

/// Fits a model's pose to the correspondence lines and the depth of all views, from coarse to fine
/// segments. Each Gauss-Newton step uses the lines' means and variances, and has a prior (SRT3D,
/// sections 3.4 and 3.5). Returns the pose it was given where too little is seen.
Eigen::Isometry3d fit_region(const ContourViews& model, Eigen::Isometry3d world_from_model,
                             const std::vector<RegionView>& views, const DepthViews& depth);

}  // namespace hypotrack::contour
