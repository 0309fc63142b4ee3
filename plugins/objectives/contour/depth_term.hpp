#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "surface_points.hpp"

namespace hypotrack::contour {

/// Distance beyond which a measured point belongs to something else, metres.
inline constexpr double kDepthReach = 0.02;

/// A point of a model and the point that a depth camera measured where the model is expected.
struct DepthMatch {
  SurfacePoint model;
  Eigen::Vector3d measured;  ///< in the world
};

/// Returns how far a measured point is beyond the plane of a model's point, along its normal.
double beyond(const DepthMatch& match, const Eigen::Isometry3d& world_from_model);

/// Matches points that face a camera with the depth measured at their pixels (as in the depth
/// modality of M. Stoiber, M. Sundermeyer, R. Triebel, "Iterative corresponding geometry", CVPR
/// 2022, section 3.3). Leaves out points whose plane is farther than kDepthReach.
std::vector<DepthMatch> match_depth(std::span<const SurfacePoint> points,
                                    const Eigen::Isometry3d& world_from_model,
                                    const TileView& view);

/// Matches of one model.
struct DepthSet {
  int offset = 0;     ///< of the model in the state
  double sigma = 1;   ///< metres
  double weight = 1;  ///< of each squared residual
  std::vector<DepthMatch> matches;
};

std::int64_t residual_count(std::span<const DepthSet> sets);

/// Writes a residual per match and returns the sum of their squares: with d of beyond(),
/// sqrt(weight) d / sigma / sqrt(1 + (d / kDepthReach)^2). Writes nothing into an empty span.
double cost_and_residuals(std::span<const DepthSet> sets, std::span<const double> state,
                          std::span<float> residuals);

/// Adds the derivatives of the residuals from row `first` on.
void write_jacobian(std::span<const DepthSet> sets, std::span<const double> state,
                    Eigen::Index first, Jacobian& jacobian);

}  // namespace hypotrack::contour
