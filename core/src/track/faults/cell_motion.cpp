#include "track/faults/cell_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <opencv2/core/hal/intrin.hpp>

#include "hypotrack/api/camera.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::size_t kTogether = cv::v_uint16x8::nlanes;

/// Returns the two halves of some cells as numbers.
std::array<cv::v_float32x4, 2> numbers(const std::uint16_t* cells) {
  cv::v_uint32x4 low, high;
  cv::v_expand(cv::v_load(cells), low, high);
  return {cv::v_cvt_f32(cv::v_reinterpret_as_s32(low)),
          cv::v_cvt_f32(cv::v_reinterpret_as_s32(high))};
}

}  // namespace

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
  const std::size_t size = a.cells.size();
  std::size_t i = 0, same = 0;
  for (; i + kTogether <= size; i += kTogether) {
    const cv::v_uint16x8 equal = cv::v_load(&a.cells[i]) == cv::v_load(&b.cells[i]);
    same += std::size_t{cv::v_reduce_sum(equal & cv::v_setall_u16(1))};
  }
  for (; i < size; ++i) same += a.cells[i] == b.cells[i];
  return size - same;
}

std::vector<std::size_t> moved_cells(const SmallPicture& before, const SmallPicture& now,
                                     float gain) {
  constexpr int kMotion = 6 * SmallPicture::kLevel;  // well above noise
  std::vector<std::size_t> out;
  const auto look_at = [&](std::size_t i) {
    const std::uint16_t from = before.cells[i], to = now.cells[i];
    if (!is_clipped(std::max(from, to)) &&
        std::abs(static_cast<float>(to) - gain * static_cast<float>(from)) > kMotion)
      out.push_back(i);
  };
  const cv::v_float32x4 gains = cv::v_setall_f32(gain), least = cv::v_setall_f32(kMotion);
  std::size_t i = 0;
  for (; i + kTogether <= now.cells.size(); i += kTogether) {
    const auto from = numbers(&before.cells[i]), to = numbers(&now.cells[i]);
    const auto moves = [&](std::size_t half) {
      return cv::v_abs(to[half] - gains * from[half]) > least;
    };
    if (!cv::v_check_any(moves(0) | moves(1))) continue;  // as almost everywhere
    for (std::size_t k = 0; k < kTogether; ++k) look_at(i + k);
  }
  for (; i < now.cells.size(); ++i) look_at(i);
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
