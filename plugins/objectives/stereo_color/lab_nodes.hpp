#pragma once

#include <vector>

#include "color-inl.hpp"

namespace hypotrack::stereo_color {

/// The table for to_lab(), asked from OpenCV.
std::vector<LabNode> lab_nodes();

}  // namespace hypotrack::stereo_color
