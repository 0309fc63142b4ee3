#pragma once

#include <array>
#include <cstdint>

#include "hypotrack/cuda/layout.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack {

/// The bones that hold a vertex, in rising order and each once, with weights in units of
/// 1 / cuda::kWholeWeight that add up: the CPU and the GPU skin with the same numbers in the same
/// order. Influences that are not used, behind the others, have weight 0 and bone 0.
struct WholeWeights {
  std::array<int, 4> bone{};
  std::array<std::uint16_t, 4> weight{};
};

HYPOTRACK_API WholeWeights whole_weights(const Mesh& mesh, int vertex);

}  // namespace hypotrack
