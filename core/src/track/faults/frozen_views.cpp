#include "track/faults/frozen_views.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace hypotrack::internal {
namespace {

constexpr int kNoisy = 3;  // frames in a row that make sure that a camera has noise

/// Returns the least number of cells that a moving part of a model changes.
std::size_t cells_of_a_part(const SmallPicture& picture) {
  constexpr std::size_t kShare = 700;  // one of so many cells
  return std::max<std::size_t>(4, picture.cells.size() / kShare);
}

bool is_alike(const std::shared_ptr<const SmallPicture>& a,
              const std::shared_ptr<const SmallPicture>& b) {
  return a && b && a->cells.size() == b->cells.size();
}

}  // namespace

FrozenViews::FrozenViews(std::vector<Camera> cameras)
    : cameras_(std::move(cameras)),
      views_(cameras_.size()),
      sights_(cameras_.size() * cameras_.size()) {}

std::optional<int> FrozenViews::next(const SmallPictures& now) {
  std::optional<int> frozen;
  if (now.size() != cameras_.size()) return frozen;  // the search refuses such a frame
  count_repeats(now);
  for (std::size_t v = 0; v < now.size(); ++v)
    if (now[v] && is_frozen(v, now) && !frozen) frozen = static_cast<int>(v);
  before_ = now;
  return all_repeat(now) ? kAll : frozen;
}

bool FrozenViews::is_frozen(std::size_t view, const SmallPictures& now) {
  constexpr int kOldest = 30;        // frames: light changes slowly
  constexpr int kSureAge = 1;        // frames in which noise alone changed a picture
  constexpr std::size_t kTimes = 8;  // what moves, against what noise or encoding moves
  constexpr std::size_t kLarge = 4;  // parts that move beside noise
  ViewState& own = views_[view];
  if (own.since.empty() || !is_alike(own.since[view], now[view])) {
    own.since = now;
    own.age = 0;
    own.moved_at.clear();
    return false;
  }
  const std::size_t part = cells_of_a_part(*now[view]);
  const bool still = is_still(*own.since[view], *now[view]);
  std::vector<std::size_t> moved;
  if (!still) moved = moved_between(view, own.since, now);
  const bool noise = 4 * moved.size() < part;
  bool frozen = false;
  if (still)
    frozen = moves_beside(view, now, part, own.noisy < kNoisy, false);
  else if (noise && own.age >= kSureAge)
    frozen =
        moves_beside(view, now, std::max(kLarge * part, kTimes * (moved.size() + 1)), true, true);
  if (!frozen) {
    ++own.clock;
    if (!moved.empty()) own.moved_at.resize(now[view]->cells.size(), -1);
    for (const std::size_t cell : moved) own.moved_at[cell] = own.clock;
  }
  own.age = still || frozen || (noise && own.age < kOldest) ? own.age + 1 : 0;
  if (own.age == 0) own.since = now;
  return frozen;
}

std::vector<std::size_t> FrozenViews::moved_between(std::size_t view, const SmallPictures& before,
                                                    const SmallPictures& now) {
  return moved_cells(*before[view], *now[view], gain(view, before[view], now[view]));
}

bool FrozenViews::moves_beside(std::size_t view, const SmallPictures& now, std::size_t least,
                               bool clips, bool recent) {
  const SmallPictures& since = views_[view].since;
  for (std::size_t other = 0; other < now.size(); ++other) {
    if (other == view || !is_alike(since[other], now[other])) continue;
    if (is_still(*since[other], *now[other])) continue;
    const std::vector<std::size_t> moved = moved_between(other, since, now);
    if (moved.size() < std::max(least, cells_of_a_part(*now[other]))) continue;
    const CellSight& places = sight(other, view, now);
    const auto count = std::ranges::count_if(moved, [&](std::size_t cell) {
      return shows(view, *now[view], places.of(cell), clips, recent);
    });
    if (static_cast<std::size_t>(count) >= least) return true;
  }
  return false;
}

bool FrozenViews::shows(std::size_t view, const SmallPicture& picture, CellSight::Cells places,
                        bool clips, bool recent) const {
  constexpr int kRecent = 30;  // frames
  const ViewState& own = views_[view];
  const std::span all(places, CellSight::kDistances);
  if (std::ranges::find(all, CellSight::kOutside) != all.end()) return false;
  const auto cell = [&](std::int32_t place) { return static_cast<std::size_t>(place); };
  if (clips && std::ranges::any_of(
                   all, [&](std::int32_t place) { return is_clipped(picture.cells[cell(place)]); }))
    return false;
  if (!recent) return true;
  return !own.moved_at.empty() && std::ranges::any_of(all, [&](std::int32_t place) {
    const int at = own.moved_at[cell(place)];
    return at >= 0 && own.clock - at < kRecent;
  });
}

void FrozenViews::count_repeats(const SmallPictures& now) {
  for (std::size_t v = 0; v < now.size() && !before_.empty(); ++v) {
    ViewState& own = views_[v];
    if (!is_alike(before_[v], now[v])) {
      own.noisy = own.repeated = 0;
      continue;
    }
    const std::size_t different = different_cells(*before_[v], *now[v]);
    if (different == 0) {
      ++own.repeated;
      continue;
    }
    changed_ = true;
    // Frames that a recorder repeats at a higher rate begin anew each time.
    if (std::exchange(own.repeated, 0) > 0) own.noisy = 0;
    const auto clear = [&] {
      const auto count = std::ranges::count_if(
          now[v]->cells, [](std::uint16_t cell) { return !is_clipped(cell); });
      return static_cast<std::size_t>(count);
    };
    const bool noisy = 2 * different > now[v]->cells.size() || 2 * different > clear();
    own.noisy = noisy ? own.noisy + 1 : 0;
  }
}

bool FrozenViews::all_repeat(const SmallPictures& now) const {
  constexpr int kRepeated = 3;  // frames: a change of the frame rate repeats single ones
  constexpr int kLong = 15;     // frames in which pictures without noise may stand still
  bool any = false;
  for (std::size_t v = 0; v < now.size(); ++v) {
    if (!now[v]) continue;
    any = true;
    if (views_[v].repeated < (views_[v].noisy >= kNoisy ? kRepeated : kLong)) return false;
  }
  return any && changed_;
}

const CellSight& FrozenViews::sight(std::size_t from, std::size_t to, const SmallPictures& now) {
  std::optional<CellSight>& out = sights_[from * cameras_.size() + to];
  if (!out || !out->fits(*now[from], *now[to]))
    out.emplace(cameras_[from], *now[from], cameras_[to], *now[to]);
  return *out;
}

}  // namespace hypotrack::internal
