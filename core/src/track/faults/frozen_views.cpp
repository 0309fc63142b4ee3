#include "track/faults/frozen_views.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "hypotrack/back_project.hpp"

namespace hypotrack::internal {
namespace {

/// Returns whether two pictures of one view are equal but for rounding, as of a video's codec.
bool is_still(const SmallPicture& a, const SmallPicture& b) {
  constexpr int kRounding = SmallPicture::kLevel / 2;
  return a.cells.size() == b.cells.size() &&
         std::equal(a.cells.begin(), a.cells.end(), b.cells.begin(),
                    [](int from, int to) { return std::abs(from - to) <= kRounding; });
}

bool is_inside(const Camera& camera, const Eigen::Vector2d& pixel) {
  return pixel.x() > 0 && pixel.y() > 0 && pixel.x() < camera.width - 1 &&
         pixel.y() < camera.height - 1;  // false for NaN
}

}  // namespace

FrozenViews::FrozenViews(std::vector<Camera> cameras)
    : cameras_(std::move(cameras)),
      since_(cameras_.size()),
      seen_(cameras_.size() * cameras_.size()) {}

std::optional<std::size_t> FrozenViews::next(const SmallPictures& now) {
  std::optional<std::size_t> frozen;
  if (now.size() != cameras_.size()) return frozen;  // the search refuses such a frame
  for (std::size_t v = 0; v < now.size(); ++v) {
    if (!now[v]) continue;
    SmallPictures& since = since_[v];
    if (since.empty() || !since[v] || !is_still(*since[v], *now[v])) {
      since = now;
      continue;
    }
    for (std::size_t w = 0; w < now.size() && !frozen; ++w)
      if (w != v && now[w] && since[w] && moves(w, v, *since[w], *now[w])) frozen = v;
  }
  return frozen;
}

bool FrozenViews::moves(std::size_t view, std::size_t other, const SmallPicture& before,
                        const SmallPicture& now) {
  constexpr int kMotion = 6 * SmallPicture::kLevel;  // well above noise
  constexpr int kClipped = 250 * SmallPicture::kLevel;
  constexpr std::size_t kLeast = 700;  // one of so many cells, a finger's motion
  if (before.cells.size() != now.cells.size() || is_still(before, now)) return false;
  const std::size_t enough = std::max<std::size_t>(4, now.cells.size() / kLeast);
  // A picture that becomes brighter does not move.
  const float gain = gain_between(before, now);
  const auto moved = [&](std::size_t i) {
    const std::uint16_t from = before.cells[i], to = now.cells[i];
    return std::max(from, to) < kClipped &&
           std::abs(static_cast<float>(to) - gain * static_cast<float>(from)) > kMotion;
  };
  std::size_t count = 0;
  for (std::size_t i = 0; i < now.cells.size(); ++i) count += moved(i);
  if (count < enough) return false;
  const std::vector<bool>& seen = seen_by(other, view, now);
  count = 0;
  for (std::size_t i = 0; i < now.cells.size(); ++i) count += seen[i] && moved(i);
  return count >= enough;
}

const std::vector<bool>& FrozenViews::seen_by(std::size_t other, std::size_t view,
                                              const SmallPicture& now) {
  // The nearest hands, and far behind them. What is seen there is also seen in between.
  constexpr std::array<double, 2> kDistances{0.25, 1000};
  std::vector<bool>& seen = seen_[view * cameras_.size() + other];
  if (seen.size() == now.cells.size()) return seen;
  Eigen::Matrix2Xd pixels(2, static_cast<Eigen::Index>(now.cells.size()));
  for (int y = 0; y < now.height; ++y)
    for (int x = 0; x < now.width; ++x)
      pixels.col(Eigen::Index{y} * now.width + x) << now.cell * (x + 0.5) - 0.5,
          now.cell * (y + 0.5) - 0.5;
  const Eigen::Matrix3Xd rays = back_project(cameras_[view], pixels);
  const Eigen::Isometry3d world_from_camera = cameras_[view].camera_from_world.inverse();
  seen.resize(now.cells.size());
  for (std::size_t i = 0; i < seen.size(); ++i)
    seen[i] = std::ranges::all_of(kDistances, [&](double distance) {
      const Eigen::Vector3d ray = rays.col(static_cast<Eigen::Index>(i));
      return is_inside(cameras_[other],
                       project(cameras_[other], world_from_camera * (distance * ray)));
    });
  return seen;
}

}  // namespace hypotrack::internal
