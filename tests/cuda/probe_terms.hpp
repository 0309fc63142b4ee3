#pragma once

#include <cstdint>
#include <cstring>
#include <memory>

#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack::test {

inline constexpr float kProbeTolerance = 0.003f;  // metres

/// Numbers below 256 that are hardly ever the same for other pixels or other depths.
struct PixelMark {
  std::uint32_t first, second;
};
HYPOTRACK_PIXEL PixelMark mark_of_pixel(int x, int y, float inverse_depth) {
  std::uint32_t bits = 0;
  static_assert(sizeof bits == sizeof inverse_depth);
  std::memcpy(&bits, &inverse_depth, sizeof bits);
  bits ^= static_cast<std::uint32_t>(x) * 0x9E3779B1u ^ static_cast<std::uint32_t>(y) * 0x85EBCA77u;
  bits = (bits ^ bits >> 15) * 0x2C1B3C6Du;
  bits = (bits ^ bits >> 12) * 0x297A2D39u;
  return {bits >> 24, bits >> 16 & 0xFFu};
}
inline constexpr double kSecondMark = 1 << 26;  ///< more than marks add up to

std::unique_ptr<cuda::DeviceObjective> covered_probe_on_device();
std::unique_ptr<cuda::DeviceObjective> seen_probe_on_device(bool uncovered);
std::unique_ptr<cuda::DeviceObjective> mark_probe_on_device();
std::unique_ptr<cuda::DeviceObjective> edge_probe_on_device();

}  // namespace hypotrack::test
