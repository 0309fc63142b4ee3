#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "track/faults/cell_motion.hpp"
#include "track/faults/small_picture.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

using SmallPictures = std::vector<std::shared_ptr<const SmallPicture>>;

/// Finds views whose picture stands still while another view shows that something moves which both
/// cameras see. A picture that moved a moment ago may also stand still under fresh noise or another
/// encoding. Also finds that all views repeat pictures exactly, which cameras with noise never do.
class FrozenViews {
 public:
  explicit FrozenViews(std::vector<Camera> cameras);

  /// Returned by next() where all views are frozen.
  static constexpr int kAll = -1;

  /// Takes the next pictures, one per camera; null: the view has no colour. Returns the first
  /// frozen view, or kAll.
  std::optional<int> next(const SmallPictures& now);

  /// Returns gain_between() of a view's pictures: mostly what next() has found.
  float gain(std::size_t view, const std::shared_ptr<const SmallPicture>& before,
             const std::shared_ptr<const SmallPicture>& now) {
    if (view >= gains_.size()) gains_.resize(view + 1);
    return gains_[view].between(before, now);
  }

 private:
  struct ViewState {
    SmallPictures since;        ///< all pictures when this view's changed last
    int age = 0;                ///< of `since`, frames
    int noisy = 0;              ///< frames in a row that differed by noise
    int repeated = 0;           ///< frames in a row that were exactly the same
    int clock = 0;              ///< frames in which the view was not frozen
    std::vector<int> moved_at;  ///< for each cell, `clock` when it moved last; empty: none did
  };

  /// Returns whether a view is frozen, and remembers its motion.
  bool is_frozen(std::size_t view, const SmallPictures& now);
  std::vector<std::size_t> moved_between(std::size_t view, const SmallPictures& before,
                                         const SmallPictures& now);
  /// Returns whether at least `least` cells of another view have moved since the picture of `view`
  /// did, where camera `view` would see it. A clipped place may not show it. With `recent`, the
  /// place has to show motion of a moment ago.
  bool moves_beside(std::size_t view, const SmallPictures& now, std::size_t least, bool clips,
                    bool recent);
  bool shows(std::size_t view, const SmallPicture& picture, CellSight::Cells places, bool clips,
             bool recent) const;
  /// Counts the frames in which views repeat their pictures or differ by noise.
  void count_repeats(const SmallPictures& now);
  /// Returns whether all views repeat their pictures for some frames.
  bool all_repeat(const SmallPictures& now) const;
  const CellSight& sight(std::size_t from, std::size_t to, const SmallPictures& now);

  std::vector<Camera> cameras_;
  std::vector<ViewState> views_;
  std::vector<LastGain> gains_;                   ///< by view
  SmallPictures before_;                          ///< of the last frame
  bool changed_ = false;                          ///< pictures of some view have moved
  std::vector<std::optional<CellSight>> sights_;  ///< by view and other view; empty: not needed
};

}  // namespace internal
}  // namespace hypotrack
