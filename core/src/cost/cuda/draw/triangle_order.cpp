#include <algorithm>
#include <cstdint>
#include <numeric>

#include "cost/cuda/draw/device_scene.hpp"

namespace hypotrack::cuda::internal {
namespace {

constexpr int kBits = 10;  // per coordinate

/// Spreads the bits of `x` with two zero bits between them (Morton code).
std::uint32_t spread_bits(std::uint32_t x) {
  std::uint32_t out = 0;
  for (int bit = 0; bit < kBits; ++bit) out |= (x >> bit & 1u) << (3 * bit);
  return out;
}

/// Returns a triangle's centre, moved outwards so that the two sides of a thin part are apart.
Eigen::Vector3f place(const Mesh& mesh, int triangle, float outwards) {
  const auto corner = [&](int k) -> Eigen::Vector3f {
    return mesh.vertices.col(mesh.triangles(k, triangle));
  };
  const Eigen::Vector3f a = corner(0), b = corner(1), c = corner(2);
  return (a + b + c) / 3.0f + outwards * (b - a).cross(c - a).stableNormalized();
}

}  // namespace

std::vector<int> order_by_place(const Mesh& mesh) {
  const auto count = static_cast<int>(mesh.triangles.cols());
  std::vector<int> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  if (count == 0) return order;
  const Eigen::Vector3f low = mesh.vertices.rowwise().minCoeff();
  const float extent = (mesh.vertices.rowwise().maxCoeff() - low).maxCoeff();
  const float outwards = extent / 6;
  const float unit = extent + 2 * outwards;
  std::vector<std::uint32_t> codes;
  for (int t = 0; t < count; ++t) {
    const Eigen::Vector3f p = (place(mesh, t, outwards) - low).array() + outwards;
    std::uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float steps = p[axis] / unit * ((1 << kBits) - 1);
      const bool valid = steps >= 0 && steps < (1 << kBits);  // false for a mesh without extent
      code |= spread_bits(valid ? static_cast<std::uint32_t>(steps) : 0u) << axis;
    }
    codes.push_back(code);
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return codes[static_cast<std::size_t>(a)] < codes[static_cast<std::size_t>(b)];
  });
  return order;
}

}  // namespace hypotrack::cuda::internal
