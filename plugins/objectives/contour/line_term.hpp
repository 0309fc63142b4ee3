#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "correspondence_lines.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack::contour {

/// Returns the derivatives of a point's place along a pixel direction by its position in the
/// camera's frame.
Eigen::Vector3d pixel_slope(const TileCamera& camera, const Eigen::Vector3d& point,
                            const Eigen::Vector2f& direction);

/// Lines of one model in one view.
struct LineSet {
  TileCamera camera;
  int offset = 0;     ///< of the model in the state
  double weight = 1;  ///< of each squared residual
  double reach = 1;   ///< pixels beyond which a line pulls less and less
  std::vector<CorrespondenceLine> lines;
};

std::int64_t residual_count(std::span<const LineSet> sets);

/// Writes a residual per line and returns the sum of their squares. With d the distance in pixels
/// of the model's point from the line's mean, along the line, the residual is
///
///   sqrt(weight) d / sigma / sqrt(1 + (d / reach)^2),
///
/// bounded as S. Geman and D. McClure do (Bayesian image analysis, 1985). Writes nothing into an
/// empty span.
double cost_and_residuals(std::span<const LineSet> sets, std::span<const double> state,
                          std::span<float> residuals);

/// Adds the derivatives of the residuals by the models' poses.
void write_jacobian(std::span<const LineSet> sets, std::span<const double> state,
                    Jacobian& jacobian);

}  // namespace hypotrack::contour
