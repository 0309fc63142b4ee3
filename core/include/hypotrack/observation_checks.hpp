#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <string_view>

#include "hypotrack/export.hpp"
#include "hypotrack/objective.hpp"
#include "hypotrack/observation.hpp"

/// Checks of an observation for objectives. All throw DataError, which names `objective`, what was
/// found and what was expected.
namespace hypotrack {

/// Throws unless an image has its tile's size and the OpenCV type. `what` names it in the message:
/// "colour image", ...
HYPOTRACK_API void check_tile_image(std::string_view objective, const cv::Mat& image, int type,
                                    const TileView& view, std::size_t index, const char* what);

/// Throws unless the first two views have colour images of their tile's size, at least 2x2 pixels.
HYPOTRACK_API void check_color_pair(std::string_view objective, const Observation& observation);

/// Throws unless both of the first two views have colour on the device. `has_color` says which of
/// them have it.
HYPOTRACK_API void check_color_pair(std::string_view objective, const Observation& header,
                                    const bool (&has_color)[2]);

/// Throws unless the hypothesis has a drawn view `index` of this size.
HYPOTRACK_API void check_drawn_tile(std::string_view objective,
                                    const RenderedHypothesis& hypothesis, std::size_t index,
                                    int width, int height);

}  // namespace hypotrack
