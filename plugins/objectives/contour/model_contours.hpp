#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "contour_views.hpp"
#include "hypotrack/plugin/model.hpp"
#include "hypotrack/plugin/plugin_object.hpp"
#include "params.hpp"

namespace hypotrack::contour {

/// Returns whether the pose alone moves the model, so that one set of outlines is enough.
bool is_rigid(const Model& model);

/// Draws a rigid model from all directions and traces its outlines. Throws DeviceError if OpenGL is
/// missing.
ContourViews draw_contours(const std::shared_ptr<const Model>& model, const ViewSettings& settings);

/// Returns a rigid model's outlines from the cache, or draws them and keeps them there. The log
/// tells of both a new file and a folder that cannot be written.
ContourViews model_contours(const std::shared_ptr<const Model>& model, const Params& params,
                            const PluginLog& log);

/// A point of an outline in a picture, in pixels.
struct TracedPoint {
  Eigen::Vector2f position;  ///< on the edge, between the pixels
  Eigen::Vector2f normal;    ///< unit, outwards
  float depth;               ///< of the border pixel beside it
  float inside, outside;     ///< length along the normal with the model, and without it
};

/// Traces the outline of a drawn model and returns about `count` points, evenly along it. `depth`
/// is 0 beside the model. Leaves out corners, which have no normal. Holes have outlines, too.
std::vector<TracedPoint> trace_contour(const cv::Mat1f& depth, int count);

}  // namespace hypotrack::contour
