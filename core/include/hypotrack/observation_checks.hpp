#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <string_view>

#include "hypotrack/export.hpp"
#include "hypotrack/objective.hpp"
#include "hypotrack/observation.hpp"

/// What an objective asks of a frame before it looks at pixels. All throw DataError, in the name of
/// `objective`, with what was found and what was expected.
namespace hypotrack {

/// Unless the image has its tile's size and the OpenCV type. `what`: "colour image", ...
HYPOTRACK_API void check_tile_image(std::string_view objective, const cv::Mat& image, int type,
                                    const TileView& view, std::size_t index, const char* what);

/// Unless the first two views have colour, on tiles of 2x2 pixels or more, and images that have
/// their tile's size and type.
HYPOTRACK_API void check_color_pair(std::string_view objective, const Observation& observation);

/// The same for a frame on a device: `has_color` tells of the first two views.
HYPOTRACK_API void check_color_pair(std::string_view objective, const Observation& header,
                                    const bool (&has_color)[2]);

/// Unless a hypothesis was drawn as view `index` with this size.
HYPOTRACK_API void check_drawn_tile(std::string_view objective,
                                    const RenderedHypothesis& hypothesis, std::size_t index,
                                    int width, int height);

}  // namespace hypotrack
