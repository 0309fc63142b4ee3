#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/scene.hpp"

// The lines of the tables that tables.hpp describes.

namespace hypotrack {

/// What stands in the cells of a landmark whose model is absent.
inline constexpr std::string_view kAbsent = "absent";

std::string states_header(const Scene& scene);
std::string landmarks_header(std::span<const std::string> landmark_names);

/// Numbers with as many digits as repeat them exactly.
std::string table_line(int frame, double time, const Eigen::Ref<const Eigen::VectorXd>& values);
/// Landmarks (3xL) one after the other; `absent` says which are (empty: none).
std::string landmarks_line(int frame, double time, const Eigen::Matrix3Xd& landmarks,
                           const std::vector<bool>& absent = {});

}  // namespace hypotrack
