#pragma once

#include <opencv2/core/mat.hpp>

namespace hypotrack::hands {

/// Returns an 8-bit BGR or grey picture as BGR, grey ones in shades of skin, in which more palms
/// are found. Throws DataError for other and for empty pictures.
cv::Mat checked_color(const cv::Mat& picture);

}  // namespace hypotrack::hands
