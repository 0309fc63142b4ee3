#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "track/faults/small_picture.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns whether a cell may hide what is brighter.
bool is_clipped(std::uint16_t cell);

/// Returns whether two pictures of one view are equal but for rounding, as of a video's codec.
bool is_still(const SmallPicture& a, const SmallPicture& b);

/// Returns the number of cells in which two pictures of one size differ at all.
std::size_t different_cells(const SmallPicture& a, const SmallPicture& b);

/// Returns the cells that move between two pictures of one size: they differ well above noise. A
/// picture that becomes brighter, by `gain` as of gain_between(), does not move, and clipped cells
/// do not tell.
std::vector<std::size_t> moved_cells(const SmallPicture& before, const SmallPicture& now,
                                     float gain);

/// Knows where another camera may see what a cell of a picture shows, from near to far.
class CellSight {
 public:
  /// Takes small pictures of both cameras for their sizes.
  CellSight(const Camera& from, const SmallPicture& picture, const Camera& to,
            const SmallPicture& other);

  /// Cells of the other picture, or kOutside.
  using Cells = const std::int32_t*;
  static constexpr std::size_t kDistances = 8;
  static constexpr std::int32_t kOutside = -1;

  /// Returns kDistances cells.
  Cells of(std::size_t cell) const { return cells_.data() + kDistances * cell; }
  /// Returns whether this is for pictures of these sizes.
  bool fits(const SmallPicture& picture, const SmallPicture& other) const;

 private:
  std::size_t size_, other_size_;  ///< cells
  std::vector<std::int32_t> cells_;
};

}  // namespace internal
}  // namespace hypotrack
