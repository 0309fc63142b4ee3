#include <fmt/format.h>

#include <cmath>

#include "model/import/steps.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kRounding = 0.02;     // weights stored as bytes are off by up to 4 / 255
constexpr double kSmallestSum = 1e-3;  // smaller ones are numbers that were read wrongly

/// Returns which vertices of a part are corners of its triangles.
std::vector<bool> corners_of(const mesh_wire::MeshPart& part) {
  std::vector<bool> used(part.positions.size());
  for (const auto& corners : part.triangles)
    for (const std::uint32_t corner : corners) used[corner] = true;
  return used;
}

/// Throws DataError unless bones hold a vertex.
void expect_held(const MeshFile& file, const mesh_wire::MeshPart& part, std::size_t vertex,
                 double sum) {
  if (sum <= 0)
    file.fail(
        fmt::format("no bone holds vertex {} of mesh '{}' (weights that are NaN, zero, "
                    "negative or of unknown bones count as none)",
                    vertex, part.name));
  if (sum < kSmallestSum)
    file.fail(
        fmt::format("the weights of vertex {} of mesh '{}' sum to {:.3g} instead of 1 (those "
                    "that are NaN, negative or of unknown bones count as none)",
                    vertex, part.name, sum));
}

}  // namespace

// The importer skips negative, NaN and misdirected weights, so their vertices lack weight.
void normalize_weights(const MeshFile& file, const mesh_wire::MeshPart& part, std::size_t first,
                       Soup& soup) {
  const std::vector<bool> used = corners_of(part);
  std::size_t scaled = 0, farthest = 0;
  double sum_there = 1;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    double sum = 0;
    for (const BoneWeight& influence : soup.influences[first + i])
      sum += static_cast<double>(influence.weight);
    expect_held(file, part, i, sum);
    if (std::abs(sum - 1) <= kRounding) continue;
    for (BoneWeight& influence : soup.influences[first + i])
      influence.weight = static_cast<float>(influence.weight / sum);
    ++scaled;
    if (std::abs(sum - 1) <= std::abs(sum_there - 1)) continue;
    farthest = i;
    sum_there = sum;
  }
  if (scaled > 0)
    soup.notes.push_back(
        fmt::format("mesh '{}': the bone weights of {} of its vertices do not sum to 1 and are "
                    "scaled to it, as viewers do; those of vertex {} differ most and sum to {:.3g}",
                    part.name, scaled, farthest, sum_there));
}

}  // namespace hypotrack::internal
