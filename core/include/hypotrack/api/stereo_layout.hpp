#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string_view>

#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/export.hpp"

namespace hypotrack {

/// How one picture holds the views of two cameras.
enum class StereoLayout {
  side_by_side,  ///< the first camera in the left half
  top_bottom,    ///< the first camera in the upper half
};
HYPOTRACK_API std::span<const std::string_view> enum_names(StereoLayout);

/// Returns the size of a view in pictures of both. Throws DataError, naming `where`, if the
/// picture has no equal halves.
HYPOTRACK_API ImageSize view_size(StereoLayout layout, int width, int height,
                                  std::string_view where);

/// Copies the first and the second camera's view out of a picture of both, which may be of any
/// type. The last column or row of an odd size is left out.
HYPOTRACK_API std::array<cv::Mat, 2> split_views(StereoLayout layout, const cv::Mat& picture);

}  // namespace hypotrack
