#pragma once

#include <array>
#include <cstdint>

#include "base/exported.hpp"
#include "hypotrack/gpu/layout.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Bone influences of a vertex with quantised weights, in units of 1 / cuda::kUnitWeight. Bones
/// are distinct and in rising order; the weights add up exactly. CPU and GPU skin with the same
/// numbers in the same order. Unused influences come last, with weight 0 and bone 0.
struct QuantizedWeights {
  std::array<int, 4> bone{};
  std::array<std::uint16_t, 4> weight{};
};

/// Quantises the bone influences of one vertex.
QuantizedWeights quantize_weights(const Mesh& mesh, int vertex);

}  // namespace internal
}  // namespace hypotrack
