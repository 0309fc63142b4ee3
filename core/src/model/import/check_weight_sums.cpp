#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "model/import/steps.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kWeightSumTolerance = 0.02;  // weights stored as bytes are off by up to 4 / 255

}  // namespace

// The importer skips negative, NaN and misdirected weights, so their vertices lack weight.
void check_weight_sums(const MeshFile& file, const mesh_wire::MeshPart& part, const Soup& soup,
                       std::size_t first) {
  std::vector<bool> used(part.positions.size());
  for (const auto& corners : part.triangles) {
    for (const std::uint32_t corner : corners) used[corner] = true;
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    double sum = 0;
    for (const BoneWeight& influence : soup.influences[first + i]) {
      sum += static_cast<double>(influence.weight);
    }
    if (sum <= 0) {
      const auto of_part = std::span(soup.influences).subspan(first, used.size());
      const bool rigid = std::ranges::all_of(of_part, [](const auto& all) { return all.empty(); });
      file.fail(fmt::format(
          "no bone holds vertex {} of mesh '{}' ({})", i, part.name,
          rigid ? "the mesh has no weights, though the file has bones: give it the weight 1 of one "
                  "bone, or take it out of the file"
                : "weights that are NaN, zero, negative or of unknown bones count as none"));
    }
    if (std::abs(sum - 1) > kWeightSumTolerance) {
      file.fail(
          fmt::format("the weights of vertex {} of mesh '{}' sum to {:.3g} instead of 1 (those "
                      "that are NaN, negative or of unknown bones count as none)",
                      i, part.name, sum));
    }
  }
}

}  // namespace hypotrack::internal
