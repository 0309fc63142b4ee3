#pragma once

#include <vector>

#include "color-inl.hpp"

namespace hypotrack::stereo_color {

/// Returns the table for to_lab(), computed by OpenCV.
std::vector<LabNode> lab_nodes();

}  // namespace hypotrack::stereo_color
