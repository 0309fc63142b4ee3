#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/export.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack {

/// A landmark that somebody marked in the first two views.
struct Click {
  std::string landmark;  ///< its name, or `model.landmark` where several models have it
  Eigen::Vector2d left = Eigen::Vector2d::Zero();  ///< pixels of the first view
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
};

/// Clicks into one frame of a source.
struct ClickedFrame {
  std::vector<Click> clicks;
  std::optional<int> frame;           ///< its index; nothing if a person wrote the clicks
  std::vector<std::string> pictures;  ///< summaries() of it; empty: it may be any frame
};

/// Reads clicks: `clicks: [{landmark: lid, left: [412, 300], right: [371, 301]}, ...]`, and
/// `frame` and `pictures` if they are given. Throws ConfigError with file:line:column.
HYPOTRACK_API ClickedFrame read_clicks(const ConfigNode& node);
/// Writes clicks as YAML, which read_clicks() reads back.
HYPOTRACK_API std::string clicks_yaml(const ClickedFrame& clicked);

/// Returns the grey levels of the first two views in 8 x 6 cells, two hexadecimal digits each; none
/// without colour pictures.
HYPOTRACK_API std::vector<std::string> summaries(const Frame& frame);

/// Throws DataError if a frame looks different from the one that was clicked. The message begins
/// with `where`.
HYPOTRACK_API void expect_clicked_frame(const ClickedFrame& clicked, const Frame& frame,
                                        const std::string& where);

/// Returns a model whose landmarks can be clicked. A rigid model has the corners of its bounding
/// box as well, where these are vertices of its mesh: `corner_xyz` with 0 (low) or 1 (high) for
/// x, y and z.
HYPOTRACK_API std::shared_ptr<const Model> clickable(const std::shared_ptr<const Model>& model);

/// Returns how many clicks place a model: 3 for a rigid one, 4 for one with joints.
HYPOTRACK_API int clicks_needed(const Model& model);

/// Distance of a click from the fit.
struct ClickResidual {
  std::string landmark;  ///< `model.landmark`
  double distance = 0;   ///< of the fitted landmark from the triangulated one, metres
  double pixels = 0;     ///< of the fitted landmark from the click, in the worse view
};

/// Models placed by clicks.
struct ClickFit {
  Eigen::VectorXd state;
  std::vector<ClickResidual> residuals;  ///< in the order of the clicks
};

/// Returns how far the click in the right view lies from the epipolar line of the left one, in
/// pixels; infinite if they cannot show one point.
HYPOTRACK_API double distance_from_epipolar_line(const std::vector<Camera>& cameras,
                                                 const Click& click);

/// Fits models to clicks: triangulates them, then calls fit_landmarks(). What no click determines
/// stays at rest. A model takes clicks_needed(), not all on a line; one without clicks stays at
/// rest. Throws ConfigError on unknown landmarks and too few clicks,
/// and DataError on clicks that do not meet within `tolerance` pixels or do not fit the model;
/// messages begin with `where`.
HYPOTRACK_API ClickFit fit_clicks(const Scene& scene, const std::vector<Camera>& cameras,
                                  std::span<const Click> clicks, double tolerance,
                                  const std::string& where);

/// Says in one line how far the clicks are from the fit.
HYPOTRACK_API std::string describe(const ClickFit& fit);

}  // namespace hypotrack
