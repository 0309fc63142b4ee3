#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <vector>

#include "color_histograms.hpp"
#include "contour_views.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack::contour {

/// A point of a model's outline in a view, with the outline's normal there.
struct SeenPoint {
  Eigen::Vector3f position;  ///< in the camera's frame
  Eigen::Vector2f pixel;
  Eigen::Vector2f normal;  ///< unit, outwards, pixels
  float inside, outside;   ///< pixels along the normal over which the model is seen, or is not
};

/// Returns how a camera sees a point of the outline. Nothing behind the camera, or where an edge is
/// no longer the outline.
std::optional<SeenPoint> seen(const ContourPoint& point, const Eigen::Isometry3f& camera_from_model,
                              const TileCamera& camera);

/// A view with the log odds of its pixels (ColorHistograms::log_odds()).
struct RegionView {
  const TileCamera* camera;
  cv::Mat4f color;  ///< blue, green and red, 0 to 255
  cv::Mat1f log_odds;
  cv::Mat1b hidden = {};  ///< not 0 where another model is before this one; empty: nowhere
};

/// A straight line of pixels across the outline, with the distribution of where along it the
/// picture changes from the model's colours to those beside it.
struct CorrespondenceLine {
  Eigen::Vector3f position;  ///< of the outline's point, in the model's frame
  Eigen::Vector2f centre;    ///< pixels
  Eigen::Vector2f normal;    ///< unit, outwards
  float mean;                ///< pixels from the centre along the normal
  float variance;            ///< square pixels
};

/// Finds the lines of one model in one view (M. Stoiber, M. Pfanne, K. H. Strobl, R. Triebel,
/// A. Albu-Schaeffer, "SRT3D: A sparse region-based 3D object tracking approach for the real
/// world", IJCV 2022, section 3): pixels are independent, `scale` of them in a row make a segment,
/// and a smoothed step says how the probability of the model falls across the outline. Lines of
/// one-pixel segments are refined (refine_place()). Lines across
/// thin parts are left out, and those where another model or unknown colours hide the model.
std::vector<CorrespondenceLine> find_lines(std::span<const ContourPoint> outline,
                                           const Eigen::Isometry3f& camera_from_model,
                                           const RegionView& view, int scale);

/// Returns a mask of a view's pixels within the convex hull of a model's outline, and three pixels
/// around it.
cv::Mat1b covered_by(std::span<const ContourPoint> outline,
                     const Eigen::Isometry3f& camera_from_model, const TileCamera& camera);

/// Counts the colours on both sides of a model's outline in a view. Returns the share of the
/// outline that lies in the picture.
double count_colors(std::span<const ContourPoint> outline,
                    const Eigen::Isometry3f& camera_from_model, const TileView& view,
                    ColorHistograms& histograms);

}  // namespace hypotrack::contour
