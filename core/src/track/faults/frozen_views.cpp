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

/// Returns the number of cells in which two pictures of one view differ at all.
std::size_t different_cells(const SmallPicture& a, const SmallPicture& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.cells.size(); ++i) count += a.cells[i] != b.cells[i];
  return count;
}

/// Returns the number of cells that move where a finger does.
std::size_t cells_of_a_finger(const SmallPicture& picture) {
  constexpr std::size_t kShare = 700;  // one of so many cells
  return std::max<std::size_t>(4, picture.cells.size() / kShare);
}

}  // namespace

FrozenViews::FrozenViews(std::vector<Camera> cameras)
    : cameras_(std::move(cameras)),
      since_(cameras_.size()),
      age_(cameras_.size()),
      seen_(cameras_.size() * cameras_.size()) {}

std::optional<int> FrozenViews::next(const SmallPictures& now) {
  constexpr int kOldest = 30;        // frames: light changes slowly
  constexpr std::size_t kTimes = 8;  // what moves, against what noise or encoding moves
  std::optional<int> frozen;
  if (now.size() != cameras_.size()) return frozen;  // the search refuses such a frame
  for (std::size_t v = 0; v < now.size(); ++v) {
    if (!now[v]) continue;
    SmallPictures& since = since_[v];
    const bool known = !since.empty() && since[v] && since[v]->cells.size() == now[v]->cells.size();
    const bool still = known && is_still(*since[v], *now[v]);
    const std::size_t moved = !known || still ? 0 : moved_cells(v, v, *since[v], *now[v]);
    bool stands = false;
    for (std::size_t w = 0; w < now.size() && known && !stands; ++w)
      stands = w != v && moves_beside(v, w, now, still ? 0 : kTimes * (moved + 1));
    stands = stands && (still || age_[v] > 0);
    if (stands && !frozen) frozen = static_cast<int>(v);
    const bool noise = known && age_[v] < kOldest && 4 * moved < cells_of_a_finger(*now[v]);
    age_[v] = still || stands || noise ? age_[v] + 1 : 0;
    if (age_[v] == 0) since = now;
  }
  if (all_repeat(now)) frozen = kAll;
  before_ = now;
  return frozen;
}

bool FrozenViews::moves_beside(std::size_t view, std::size_t other, const SmallPictures& now,
                               std::size_t least) {
  const SmallPictures& since = since_[view];
  if (!now[other] || !since[other]) return false;
  if (since[other]->cells.size() != now[other]->cells.size()) return false;
  if (is_still(*since[other], *now[other])) return false;
  least = std::max(least, cells_of_a_finger(*now[other]));
  return moved_cells(other, other, *since[other], *now[other]) >= least &&
         moved_cells(other, view, *since[other], *now[other]) >= least;
}

bool FrozenViews::all_repeat(const SmallPictures& now) {
  constexpr int kRepeated = 3;  // frames: a change of the frame rate repeats single ones
  if (before_.empty()) return false;
  bool same = true, noisy = true, any = false;
  for (std::size_t v = 0; v < now.size(); ++v) {
    if (!now[v]) continue;
    if (!before_[v] || before_[v]->cells.size() != now[v]->cells.size()) return false;
    const std::size_t different = different_cells(*before_[v], *now[v]);
    any = true;
    same = same && different == 0;
    noisy = noisy && 2 * different > now[v]->cells.size();
  }
  if (!same) noisy_ = noisy;
  repeated_ = any && same ? repeated_ + 1 : 0;
  return noisy_ && repeated_ >= kRepeated;
}

std::size_t FrozenViews::moved_cells(std::size_t view, std::size_t other,
                                     const SmallPicture& before, const SmallPicture& now) {
  constexpr int kMotion = 6 * SmallPicture::kLevel;  // well above noise
  constexpr int kClipped = 250 * SmallPicture::kLevel;
  // A picture that becomes brighter does not move.
  const float gain = gain_between(before, now);
  const std::vector<bool>* seen = view == other ? nullptr : &seen_by(other, view, now);
  std::size_t count = 0;
  for (std::size_t i = 0; i < now.cells.size(); ++i) {
    const std::uint16_t from = before.cells[i], to = now.cells[i];
    count += std::max(from, to) < kClipped && (!seen || (*seen)[i]) &&
             std::abs(static_cast<float>(to) - gain * static_cast<float>(from)) > kMotion;
  }
  return count;
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
