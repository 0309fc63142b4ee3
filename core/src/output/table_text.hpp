#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "hypotrack/scene.hpp"

// The lines of the tables that tables.hpp describes.

namespace hypotrack {

std::string states_header(const Scene& scene);
std::string landmarks_header(std::span<const std::string> landmark_names);

/// Numbers with as many digits as repeat them exactly; landmarks go in one after the other.
std::string table_line(int frame, double time, const Eigen::Ref<const Eigen::VectorXd>& values);

}  // namespace hypotrack
