#pragma once

#include <limits>

namespace hypotrack::test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace hypotrack::test
