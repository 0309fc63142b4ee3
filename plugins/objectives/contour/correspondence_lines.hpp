#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <vector>

#include "color_histograms.hpp"
#include "contour_views.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "line_places.hpp"

namespace hypotrack::contour {

/// A point of a model's outline in a view, with the outline's normal there.
struct SeenPoint {
  Eigen::Vector3f position;  ///< in the camera's frame
  Eigen::Vector2f pixel;
  Eigen::Vector2f normal;  ///< unit, outwards, pixels
  float inside, outside;   ///< pixels along the normal over which the model is seen, or is not
};

/// Returns the side, in pixels, of a tile that would hold the model alone; at most the view's. How
/// far lines reach depends on it.
float extent_of(const ContourViews& model, const Eigen::Isometry3f& camera_from_model,
                const TileCamera& camera);

/// Returns how a camera sees a point of the outline. Nothing behind the camera, or where an edge is
/// no longer the outline.
std::optional<SeenPoint> seen(const ContourPoint& point, const Eigen::Isometry3f& camera_from_model,
                              const TileCamera& camera);

/// A view as the lines of one model see it.
struct RegionView {
  const TileCamera* camera;
  RegionPixels pixels;
  cv::Mat1f nearest = {};  ///< add_cover() of all models; empty: there is one only
  float distance = 0;      ///< of this model in it: nearer ones hide it
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
/// and a smoothed step says how the probability of the model falls across the outline
/// (find_places()). Lines across thin parts are left out, and those where another model or unknown
/// colours hide the model.
std::vector<CorrespondenceLine> find_lines(std::span<const ContourPoint> outline,
                                           const Eigen::Isometry3f& camera_from_model,
                                           const RegionView& view, int scale);

/// Lowers the distances of the models next to a camera to that of one model, at its pixels: within
/// the convex hull of its outline, and three pixels around it.
void add_cover(std::span<const ContourPoint> outline, const Eigen::Isometry3f& camera_from_model,
               const TileCamera& camera, float distance, cv::Mat1f& nearest);

/// What a view shows of one model.
struct ColorView {
  const TileView* view;
  const cv::Mat1f& nearest;  ///< and the model's distance: see RegionView
  float distance;
};

/// Counts the colours up to `reach` pixels from a model's outline in a view, on both sides. Returns
/// the share of the outline that lies in the picture.
double count_colors(std::span<const ContourPoint> outline,
                    const Eigen::Isometry3f& camera_from_model, const ColorView& seen_in,
                    float reach, ColorHistograms& histograms);

}  // namespace hypotrack::contour
