#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "correspondence_lines.hpp"
#include "hypotrack/plugin/linearization.hpp"
#include "hypotrack/plugin/model.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack::contour {

/// Returns the derivatives of R(q) x by the components w, x, y, z of a unit quaternion.
inline Eigen::Matrix<double, 3, 4> quaternion_slopes(std::span<const double, 4> q,
                                                     const Eigen::Vector3d& x) {
  const double w = q[0];
  const Eigen::Vector3d v(q[1], q[2], q[3]);
  Eigen::Matrix3d cross;
  cross << 0, -x.z(), x.y(), x.z(), 0, -x.x(), -x.y(), x.x(), 0;
  Eigen::Matrix<double, 3, 4> out;
  out.col(0) = 2 * (w * x + v.cross(x));
  out.rightCols<3>() = 2 * (v.dot(x) * Eigen::Matrix3d::Identity() + v * x.transpose() -
                            x * v.transpose() - w * cross);
  return out;
}

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
  std::size_t view = 0;
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

/// Returns by which turn of the second view's camera (CameraTurnTerm) the lines of both views agree
/// best on each model's pose: a Gauss-Newton step of poses and turn together. Sets of a model stand
/// together. Returns nothing without lines in both views.
std::optional<CameraTurn> camera_turn(std::span<const LineSet> sets, std::span<const double> state);

/// A point on a model's surface with its unit normal, outwards. In the model's frame.
struct SurfacePoint {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;
};

/// Returns `count` points spread evenly over a mesh's surface; equal meshes give equal points.
/// Normals point outwards, also where all triangles face inwards.
std::vector<SurfacePoint> spread_points(const Mesh& mesh, int count);

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
