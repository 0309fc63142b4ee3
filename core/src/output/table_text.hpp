#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"

// Lines of the tables that tables.hpp describes.

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Text in the cells of a landmark whose model is absent.
inline constexpr std::string_view kAbsent = "absent";

std::string states_header(const Scene& scene);

/// Returns a line of landmarks (3xL), one after the other. `absent` flags absent ones (empty:
/// none).
std::string landmarks_line(int frame, double time, const Eigen::Matrix3Xd& landmarks,
                           const std::vector<bool>& absent = {});

}  // namespace internal
}  // namespace hypotrack
