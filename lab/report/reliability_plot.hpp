#pragma once

#include <string>

#include "hypotrack/export.hpp"
#include "output/metrics/reliability.hpp"

namespace hypotrack {

/// A reliability diagram as SVG: for each bin of sigma the root mean square of what landmarks are
/// off by, over that of sigma, both on logarithmic axes in millimetres. Where sigma is right, dots
/// lie on the diagonal; their areas follow the numbers of landmarks.
HYPOTRACK_API std::string reliability_svg(const Reliability& reliability, const std::string& title);

}  // namespace hypotrack
