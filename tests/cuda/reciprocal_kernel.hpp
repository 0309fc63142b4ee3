#pragma once

#include <cstdint>
#include <vector>

namespace hypotrack::test {

/// What cuda::exact_reciprocal() makes of the floats whose bits are first, first + 1, ...
std::vector<float> exact_reciprocals(std::uint32_t first, std::uint32_t count);

}  // namespace hypotrack::test
