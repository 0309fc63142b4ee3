#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/params.hpp"
#include "session/session.hpp"
#include "session/shape_settings.hpp"
#include "shape/shape_targets.hpp"
#include "track/tracker.hpp"

namespace hypotrack {

/// What fitting a shape has found.
struct ShapeEstimate {
  std::vector<ShapeParameter> shape;   ///< of the models, all of it
  std::vector<ShapeParameter> wanted;  ///< what was looked for, with its values
  Eigen::VectorXd deviation;           ///< standard error of `wanted`, from fits to parts of
                                       ///< the frames; NaN: not known
  int tracked_frames = 0;              ///< in the last round
  int used_frames = 0;
  double first_cost = 0, cost = 0;     ///< of the last round's joint fit
  std::vector<std::string> overrides;  ///< that give a scene's models this shape
};

/// Where estimating stands, and whether it is to go on.
struct ShapeProgress {
  std::function<void(int round)> begin_round = [](int) {};
  std::function<void(const Frame&, const Solution&)> tracked = [](const Frame&, const Solution&) {};
  std::function<void(int round, const ShapeEstimate&)> end_round = [](int, const ShapeEstimate&) {};
  std::function<bool()> stop = [] { return false; };
};

/// A session of the scene whose models are changed by `overrides`, its source at the beginning.
using OpenShaped = std::function<Session(const std::vector<std::string>& overrides)>;

/// Tracks and fits in turn, `settings.rounds` times: the frames are tracked with the shape found so
/// far, some of them are taken, and shape and poses are fitted to them together (fit_jointly,
/// ImageProblem). Frames that explain much less than the others are left out as not tracked.
/// `limit`: frames of the source to look at; 0: all. `deviations`: find out how sure the shape is,
/// too, which takes as long again as the last round's fit. Throws ConfigError if the objective has
/// no residuals or a model no shape, DataError if fewer than 2 frames were tracked or most of them
/// explain nothing.
HYPOTRACK_API ShapeEstimate estimate_shape(const OpenShaped& open,
                                           const ShapeEstimateSettings& settings, int limit,
                                           bool deviations, const ShapeProgress& progress = {});

/// The shape of the models whose landmarks the source's truth knows, fitted to `settings.frames` of
/// them (LandmarkProblem). The session's source is at its beginning. Throws DataError if fewer than
/// 2 frames have a truth, ConfigError if a model has no shape.
HYPOTRACK_API ShapeEstimate shape_of_labels(Session session, const ShapeEstimateSettings& settings,
                                            int limit);

/// The shape as a file for `shape_file`, what it was made of in comments.
HYPOTRACK_API std::string shape_file_text(const ShapeEstimate& estimate);

}  // namespace hypotrack
