#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/camera.hpp"
#include "track/faults/small_picture.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

using SmallPictures = std::vector<std::shared_ptr<const SmallPicture>>;

/// Finds views whose picture stands still while another view shows that something moves which both
/// cameras see. A picture stands still also under fresh noise or another encoding. Also finds that
/// all views repeat pictures exactly, which cameras with noise never do.
class FrozenViews {
 public:
  explicit FrozenViews(std::vector<Camera> cameras);

  /// Returned by next() where all views are frozen.
  static constexpr int kAll = -1;

  /// Takes the next pictures, one per camera; null: the view has no colour. Returns the first
  /// frozen view, or kAll.
  std::optional<int> next(const SmallPictures& now);

 private:
  /// Returns how many cells of `view` show motion since `before` where camera `other` would see
  /// it.
  std::size_t moved_cells(std::size_t view, std::size_t other, const SmallPicture& before,
                          const SmallPicture& now);
  /// Returns whether at least so many cells of `other`, and those of a finger, have moved since
  /// the picture of `view` did, where camera `view` would see it.
  bool moves_beside(std::size_t view, std::size_t other, const SmallPictures& now,
                    std::size_t least);
  /// Returns whether all views repeat their pictures for some frames, noise included.
  bool all_repeat(const SmallPictures& now);
  /// Returns for each cell of `view` whether camera `other` sees what is there, near or far.
  const std::vector<bool>& seen_by(std::size_t other, std::size_t view, const SmallPicture& now);

  std::vector<Camera> cameras_;
  std::vector<SmallPictures> since_;     ///< for each view, all pictures when its own changed last
  std::vector<int> age_;                 ///< of each of them, frames
  SmallPictures before_;                 ///< of the last frame
  bool noisy_ = false;                   ///< pictures of all views differed by noise last
  int repeated_ = 0;                     ///< frames in a row that were exactly the same
  std::vector<std::vector<bool>> seen_;  ///< by view and other view; empty: not needed so far
};

}  // namespace internal
}  // namespace hypotrack
