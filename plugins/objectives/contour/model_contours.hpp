#pragma once

#include <memory>

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

}  // namespace hypotrack::contour
