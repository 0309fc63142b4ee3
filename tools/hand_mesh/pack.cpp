#include "pack.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Vector2d;

constexpr int kGrid = 200;

/// The cells that a chart needs, its own and one around them; `low` is the chart's corner there.
struct Stamp {
  int width = 0, height = 0;
  std::vector<Vector2d> flat;  ///< turned and scaled, in cells
  std::vector<std::pair<int, int>> cells;
};

bool near_triangle(const Vector2d& p, const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  constexpr double kReach = 1.25;  // cells: half a diagonal and a margin
  const Vector2d* corners[] = {&a, &b, &c};
  for (int i = 0; i < 3; ++i) {
    const Vector2d edge = *corners[(i + 1) % 3] - *corners[i];
    const Vector2d to = p - *corners[i];
    if (edge.x() * to.y() - edge.y() * to.x() < -kReach * edge.norm()) return false;
  }
  return true;
}

Stamp make_stamp(const Chart& chart, double cells_per_mm, double angle) {
  Stamp stamp;
  const double c = std::cos(angle) * cells_per_mm, s = std::sin(angle) * cells_per_mm;
  Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  for (const Vector2d& p : chart.flat) {
    stamp.flat.emplace_back(c * p.x() - s * p.y(), s * p.x() + c * p.y());
    low = low.cwiseMin(stamp.flat.back());
    high = high.cwiseMax(stamp.flat.back());
  }
  for (Vector2d& p : stamp.flat) p += Vector2d(1.5, 1.5) - low;
  stamp.width = static_cast<int>(std::ceil(high.x() - low.x())) + 3;
  stamp.height = static_cast<int>(std::ceil(high.y() - low.y())) + 3;
  std::vector<bool> used(static_cast<size_t>(stamp.width) * stamp.height, false);
  for (const Triangle& t : chart.triangles) {
    const Vector2d &p = stamp.flat[t[0]], &q = stamp.flat[t[1]], &r = stamp.flat[t[2]];
    const Vector2d from = p.cwiseMin(q).cwiseMin(r), to = p.cwiseMax(q).cwiseMax(r);
    for (int y = std::max(0, static_cast<int>(from.y()) - 2);
         y < std::min(stamp.height, static_cast<int>(to.y()) + 3); ++y)
      for (int x = std::max(0, static_cast<int>(from.x()) - 2);
           x < std::min(stamp.width, static_cast<int>(to.x()) + 3); ++x)
        if (near_triangle(Vector2d(x + 0.5, y + 0.5), p, q, r)) used[y * stamp.width + x] = true;
  }
  for (int y = 0; y < stamp.height; ++y)
    for (int x = 0; x < stamp.width; ++x)
      if (used[y * stamp.width + x]) stamp.cells.emplace_back(x, y);
  return stamp;
}

class Sheet {
 public:
  /// The lowest row, then column, where a stamp fits; false if there is none.
  bool find(const Stamp& stamp, int& column, int& row) const {
    for (row = 0; row + stamp.height <= kGrid; ++row)
      for (column = 0; column + stamp.width <= kGrid; ++column)
        if (fits(stamp, column, row)) return true;
    return false;
  }

  void put(const Stamp& stamp, int column, int row) {
    for (const auto& [x, y] : stamp.cells) used_[(row + y) * kGrid + column + x] = true;
  }

 private:
  bool fits(const Stamp& stamp, int column, int row) const {
    return std::none_of(stamp.cells.begin(), stamp.cells.end(), [&](const auto& cell) {
      return used_[(row + cell.second) * kGrid + column + cell.first];
    });
  }

  std::vector<bool> used_ = std::vector<bool>(kGrid * kGrid, false);
};

/// Places the charts, largest first, each turned such that it ends as low as possible.
bool try_pack(std::vector<Chart>& charts, const std::vector<int>& order, double cells_per_mm) {
  Sheet sheet;
  std::vector<std::vector<Vector2d>> placed(charts.size());
  for (int i : order) {
    Stamp best;
    int best_column = 0, best_row = 0, best_top = kGrid + 1;
    for (int turn = 0; turn < 12; ++turn) {
      Stamp stamp = make_stamp(charts[i], cells_per_mm, turn * std::numbers::pi / 6);
      int column = 0, row = 0;
      if (!sheet.find(stamp, column, row) || row + stamp.height >= best_top) continue;
      best_top = row + stamp.height;
      best_column = column;
      best_row = row;
      best = std::move(stamp);
    }
    if (best_top > kGrid) return false;
    sheet.put(best, best_column, best_row);
    for (const Vector2d& p : best.flat)
      placed[i].push_back((p + Vector2d(best_column, best_row)) / kGrid);
  }
  for (size_t i = 0; i < charts.size(); ++i) charts[i].flat = std::move(placed[i]);
  return true;
}

double area(const Chart& chart) {
  double sum = 0;
  for (const Triangle& t : chart.triangles) {
    const Vector2d a = chart.flat[t[1]] - chart.flat[t[0]], b = chart.flat[t[2]] - chart.flat[t[0]];
    sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return sum;
}

}  // namespace

double pack(std::vector<Chart>& charts) {
  std::vector<int> order(charts.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> areas;
  double total = 0;
  for (const Chart& chart : charts) {
    areas.push_back(area(chart));
    total += areas.back();
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return areas[a] > areas[b]; });
  double scale = 0.9 * kGrid / std::sqrt(total);
  while (!try_pack(charts, order, scale)) scale *= 0.97;
  return scale / kGrid;
}

}  // namespace hypotrack::hand_mesh
