#include "track/faults/cell_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "hypotrack/api/camera.hpp"

namespace hypotrack::internal {

bool is_clipped(std::uint16_t cell) {
  constexpr int kClipped = 250 * SmallPicture::kLevel;
  return cell >= kClipped;
}

bool is_still(const SmallPicture& a, const SmallPicture& b) {
  constexpr int kRounding = SmallPicture::kLevel / 2;
  return a.cells.size() == b.cells.size() &&
         std::equal(a.cells.begin(), a.cells.end(), b.cells.begin(),
                    [](int from, int to) { return std::abs(from - to) <= kRounding; });
}

std::size_t different_cells(const SmallPicture& a, const SmallPicture& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.cells.size(); ++i) count += a.cells[i] != b.cells[i];
  return count;
}

std::vector<std::size_t> moved_cells(const SmallPicture& before, const SmallPicture& now) {
  constexpr int kMotion = 6 * SmallPicture::kLevel;  // well above noise
  const float gain = gain_between(before, now);
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < now.cells.size(); ++i) {
    const std::uint16_t from = before.cells[i], to = now.cells[i];
    if (!is_clipped(std::max(from, to)) &&
        std::abs(static_cast<float>(to) - gain * static_cast<float>(from)) > kMotion)
      out.push_back(i);
  }
  return out;
}

CellSight::CellSight(const Camera& from, const SmallPicture& picture, const Camera& to,
                     const SmallPicture& other)
    : size_(picture.cells.size()), other_size_(other.cells.size()) {
  // The nearest models, and far behind them.
  constexpr double kNearest = 0.25, kFarthest = 1000;
  Eigen::Matrix2Xd pixels(2, static_cast<Eigen::Index>(size_));
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      pixels.col(Eigen::Index{y} * picture.width + x) << picture.cell * (x + 0.5) - 0.5,
          picture.cell * (y + 0.5) - 0.5;
  const Eigen::Matrix3Xd rays = back_project(from, pixels);
  const Eigen::Isometry3d world_from_camera = from.camera_from_world.inverse();
  cells_.reserve(kDistances * size_);
  for (const auto& ray : rays.colwise()) {
    for (std::size_t i = 0; i < kDistances; ++i) {
      const double share = static_cast<double>(i) / (kDistances - 1);
      const double distance = 1 / ((1 - share) / kNearest + share / kFarthest);
      const Eigen::Vector2d at = project(to, world_from_camera * (distance * ray));
      const bool inside = at.x() > 0 && at.y() > 0 && at.x() < to.width - 1 &&
                          at.y() < to.height - 1;  // false for NaN
      const auto cell_at = [&](double pixel, int count) {
        return std::min(static_cast<int>((pixel + 0.5) / other.cell), count - 1);
      };
      cells_.push_back(inside ? cell_at(at.y(), other.height) * other.width +
                                    cell_at(at.x(), other.width)
                              : kOutside);
    }
  }
}

bool CellSight::fits(const SmallPicture& picture, const SmallPicture& other) const {
  return picture.cells.size() == size_ && other.cells.size() == other_size_;
}

}  // namespace hypotrack::internal
