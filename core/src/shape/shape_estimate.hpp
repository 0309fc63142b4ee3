#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/params.hpp"
#include "session/opened_scene.hpp"
#include "session/shape_settings.hpp"
#include "shape/shape_targets.hpp"
#include "track/loop/scene_tracker.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The result of fitting a shape.
struct ShapeEstimate {
  std::vector<ShapeParameter> shape;   ///< all shape parameters of the models
  std::vector<ShapeParameter> wanted;  ///< the fitted parameters, with their values
  Eigen::VectorXd deviation;  ///< standard error of `wanted`, from fits to parts of the frames;
                              ///< NaN: unknown
  /// Mean distance of the labelled landmarks before and after the fit, in metres; NaN: no labels.
  double first_distance = std::numeric_limits<double>::quiet_NaN();
  double distance = std::numeric_limits<double>::quiet_NaN();
  int tracked_frames = 0;  ///< in the last round
  int used_frames = 0;
  double first_cost = 0, cost = 0;     ///< of the last round's joint fit
  std::vector<std::string> overrides;  ///< scene overrides that give the models this shape
};

/// Writes values of the wanted parameters into an estimate, of unknown deviation.
void take_shape(const ShapeTargets& targets, const Eigen::VectorXd& values,
                ShapeEstimate& estimate);

/// Callbacks that report the progress of an estimate, and may stop it.
struct ShapeProgress {
  std::function<void(int round)> begin_round = [](int) {};
  std::function<void(const Frame&, const Solution&)> tracked = [](const Frame&, const Solution&) {};
  std::function<void(int round, const ShapeEstimate&)> end_round = [](int, const ShapeEstimate&) {};
  std::function<bool()> stop = [] { return false; };
};

/// Opens a session of the scene with models changed by `overrides` and the source at its beginning.
using OpenShaped = std::function<OpenedScene(const std::vector<std::string>& overrides)>;

/// Estimates the shape by tracking and fitting in turn, `settings.rounds` times. Each round tracks
/// the frames with the shape found so far and samples some of them. Then it fits shape and poses to
/// them together (fit_jointly, ImageProblem). Frames that explain much less than the others are
/// left out as not tracked.
///
/// `limit`: number of frames of the source to read; 0: all. `deviations`: also estimate standard
/// errors, which takes as long again as the last round's fit. Throws ConfigError if the objective
/// has no residuals or a model no shape. Throws DataError if fewer than 2 frames were tracked or
/// most of them explain nothing.
ShapeEstimate estimate_shape(const OpenShaped& open, const ShapeEstimateSettings& settings,
                             int limit, bool deviations, const ShapeProgress& progress = {});

/// Fits the shape to the true landmarks of `settings.frames` frames (LandmarkProblem). It fits the
/// models whose landmarks the source's truth knows. The session's source must be at its beginning.
/// Throws DataError if fewer than 2 frames have a truth, ConfigError if a model has no shape.
ShapeEstimate shape_of_labels(OpenedScene session, const ShapeEstimateSettings& settings,
                              int limit);

/// Returns a warning for every fitted parameter that ends within 0.5 % of one of its bounds.
std::vector<std::string> warnings_of_bounds(const ShapeEstimate& estimate);

/// Returns the text of a `shape_file` with the shape, and its origin and warnings in comments.
std::string shape_file_text(const ShapeEstimate& estimate);

/// Estimates how large the models are, from what the scene's starters see in up to twice
/// `settings.frames` frames of its source: the most probable size for the median of their sizes.
/// Keeps the size given, and uses no frame, if they see the models well in fewer than 3. Throws
/// ConfigError if no starter detects a model or `settings.parameters` lacks `scale`.
ShapeEstimate size_by_starters(OpenedScene session, const ShapeEstimateSettings& settings);

}  // namespace internal
}  // namespace hypotrack
