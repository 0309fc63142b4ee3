#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "hand_detector.hpp"
#include "hypotrack/api/camera.hpp"

namespace hypotrack::hands {

/// Looks for the hands of one view in the other, where a hand of average size would be. Adds what
/// it finds beside the hands that are known there.
void look_in_other_view(const HandDetector& detector, const std::array<Camera, 2>& cameras,
                        const std::vector<HandDetection>& seen, std::size_t view,
                        const cv::Mat& other_picture, std::vector<HandDetection>& known);

}  // namespace hypotrack::hands
