#include "scene/quantized_weights.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace hypotrack::internal {

QuantizedWeights quantize_weights(const Mesh& mesh, int vertex) {
  std::map<int, int> weight_of;
  int rest = cuda::kUnitWeight;
  for (int k = 0; k < 4; ++k) {
    const auto weight =
        static_cast<int>(std::lround(mesh.bone_weights(k, vertex) * cuda::kUnitWeight));
    if (weight <= 0) continue;
    weight_of[mesh.bone_indices(k, vertex)] += weight;
    rest -= weight;
  }
  const auto largest =
      std::max_element(weight_of.begin(), weight_of.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  largest->second += rest;  // the rounding error
  QuantizedWeights out;
  std::size_t k = 0;
  for (const auto& [bone, weight] : weight_of) {
    out.bone[k] = bone;
    out.weight[k++] = static_cast<std::uint16_t>(weight);
  }
  return out;
}

}  // namespace hypotrack::internal
