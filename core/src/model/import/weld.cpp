#include "model/import/weld.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

namespace hypotrack::internal {
namespace {

/// A grid of points. Its cells are much wider than the tolerance, so that the ball around a point
/// rarely touches more than one.
class Grid {
 public:
  Grid(const Eigen::Vector3f& origin, float tolerance)
      : origin_(origin.cast<double>()), tolerance_(tolerance), cell_(64.0 * tolerance) {}

  /// Returns the first point in the grid within the tolerance of `p` that `matches`, or -1.
  template <class Matches>
  int find(const Eigen::Matrix3Xf& points, const Eigen::Vector3f& p, const Matches& matches) const {
    const Eigen::Vector3d relative = p.cast<double>() - origin_;
    const auto low = cell(relative.array() - tolerance_);
    const auto high = cell(relative.array() + tolerance_);
    int found = -1;
    for (std::int64_t x = low.x(); x <= high.x(); ++x) {
      for (std::int64_t y = low.y(); y <= high.y(); ++y) {
        for (std::int64_t z = low.z(); z <= high.z(); ++z) {
          const auto entry = cells_.find(key(x, y, z));
          if (entry == cells_.end()) continue;
          for (const int candidate : entry->second) {
            const bool near = (points.col(candidate) - p).norm() <= tolerance_;
            if (near && (found < 0 || candidate < found) && matches(candidate)) found = candidate;
          }
        }
      }
    }
    return found;
  }

  void add(const Eigen::Vector3f& p, int index) {
    const auto at = cell((p.cast<double>() - origin_).array());
    cells_[key(at.x(), at.y(), at.z())].push_back(index);
  }

 private:
  using Cell = Eigen::Matrix<std::int64_t, 3, 1>;
  Cell cell(const Eigen::Array3d& relative) const {
    return (relative / cell_).floor().cast<std::int64_t>().matrix();
  }
  // At most 1 / (64 * 1e-6) cells per axis plus one at either end; 21 bits are enough.
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::uint64_t>(x + 1) << 42 | static_cast<std::uint64_t>(y + 1) << 21 |
           static_cast<std::uint64_t>(z + 1);
  }
  Eigen::Vector3d origin_;
  double tolerance_;
  double cell_;
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;
};

using Influences = std::vector<BoneWeight>;

/// Sorts influences by bone, and adds up several entries of one bone.
Influences by_bone(Influences influences) {
  std::sort(influences.begin(), influences.end(),
            [](const BoneWeight& a, const BoneWeight& b) { return a.bone < b.bone; });
  Influences merged;
  for (const BoneWeight& influence : influences) {
    if (!merged.empty() && merged.back().bone == influence.bone) {
      merged.back().weight += influence.weight;
    } else {
      merged.push_back(influence);
    }
  }
  return merged;
}

/// Returns the sum of the differences of two lists' weights, which by_bone() has sorted.
float difference(const Influences& a, const Influences& b) {
  float sum = 0;
  auto at = b.begin();
  for (const BoneWeight& influence : a) {
    for (; at != b.end() && at->bone < influence.bone; ++at) sum += at->weight;
    const bool both = at != b.end() && at->bone == influence.bone;
    sum += both ? std::abs(influence.weight - at->weight) : influence.weight;
    if (both) ++at;
  }
  for (; at != b.end(); ++at) sum += at->weight;
  return sum;
}

}  // namespace

std::vector<int> weld_points(const Eigen::Matrix3Xf& points,
                             const std::vector<std::vector<BoneWeight>>& influences) {
  std::vector<int> representative(static_cast<std::size_t>(points.cols()), 0);
  if (points.cols() == 0) return representative;
  const Eigen::Vector3f low = points.rowwise().minCoeff();
  const double diagonal = (points.rowwise().maxCoeff() - low).cast<double>().norm();
  const auto tolerance = static_cast<float>(kWeldTolerance * diagonal);
  if (!(tolerance > 0)) return representative;  // all points coincide
  std::vector<Influences> held;
  held.reserve(influences.size());
  for (const Influences& of_point : influences) held.push_back(by_bone(of_point));
  Grid grid(low, tolerance);
  for (int i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3f p = points.col(i);
    const int found = grid.find(points, p, [&](int other) {
      return held.empty() || difference(held[static_cast<std::size_t>(i)],
                                        held[static_cast<std::size_t>(other)]) <= kEqualWeights;
    });
    representative[static_cast<std::size_t>(i)] = found < 0 ? i : found;
    if (found < 0) grid.add(p, i);
  }
  return representative;
}

std::vector<BoneWeight> strongest_influences(std::vector<BoneWeight> influences) {
  std::vector<BoneWeight> merged = by_bone(std::move(influences));
  std::stable_sort(merged.begin(), merged.end(),
                   [](const BoneWeight& a, const BoneWeight& b) { return a.weight > b.weight; });
  merged.resize(std::min<std::size_t>(merged.size(), 4));
  std::erase_if(merged, [](const BoneWeight& influence) { return influence.weight <= 0; });
  float sum = 0;
  for (const BoneWeight& influence : merged) sum += influence.weight;
  for (BoneWeight& influence : merged) influence.weight /= sum;
  return merged;
}

}  // namespace hypotrack::internal
