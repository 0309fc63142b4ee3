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
/// cameras see.
class FrozenViews {
 public:
  explicit FrozenViews(std::vector<Camera> cameras);

  /// Takes the next pictures, one per camera; null: the view has no colour. Returns the first
  /// frozen view.
  std::optional<std::size_t> next(const SmallPictures& now);

 private:
  /// Returns whether `view` shows motion since `before` where camera `other` would see it.
  bool moves(std::size_t view, std::size_t other, const SmallPicture& before,
             const SmallPicture& now);
  /// Returns for each cell of `view` whether camera `other` sees what is there, near or far.
  const std::vector<bool>& seen_by(std::size_t other, std::size_t view, const SmallPicture& now);

  std::vector<Camera> cameras_;
  std::vector<SmallPictures> since_;     ///< for each view, all pictures when its own changed last
  std::vector<std::vector<bool>> seen_;  ///< by view and other view; empty: not needed so far
};

}  // namespace internal
}  // namespace hypotrack
