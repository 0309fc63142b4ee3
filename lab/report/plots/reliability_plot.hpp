#pragma once

#include <string>

#include "base/exported.hpp"
#include "output/metrics/reliability.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Draws a reliability diagram as SVG. For each bin of sigma it shows the root mean square error of
/// landmarks over that of sigma, on logarithmic axes in millimetres. Dots lie on the diagonal if
/// sigma is calibrated; their areas follow the numbers of landmarks.
std::string reliability_svg(const Reliability& reliability, const std::string& title);

}  // namespace internal
}  // namespace hypotrack
