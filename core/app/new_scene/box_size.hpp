#pragma once

#include <Eigen/Core>
#include <string>

namespace hypotrack::app {

/// Reads the edges of a box, `60x120x30mm` or `6x12x3cm`, in millimetres. Throws ConfigError.
Eigen::Vector3d box_size_mm(const std::string& text);

}  // namespace hypotrack::app
