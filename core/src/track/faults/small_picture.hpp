#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A small grey picture of a view, of about 160 cells in a row. A cell is the mean of some pixels
/// of one row, in 1/16 of a grey level.
struct SmallPicture {
  static constexpr int kLevel = 16;  ///< a grey level

  int width = 0;
  int height = 0;
  int cell = 1;  ///< side of a cell, in pixels
  std::vector<std::uint16_t> cells;
  double mean = 0;   ///< grey levels
  double black = 0;  ///< share of the cells
  double white = 0;  ///< share of the cells

  const std::uint16_t* row(int y) const { return cells.data() + std::ptrdiff_t{y} * width; }
};

/// Shrinks a picture, 8-bit BGR. Reads one in `cell` rows: 1280x720 pixels take some 0.05 ms.
SmallPicture shrink(const cv::Mat& color);

/// Returns by how much the second of two pictures of one size is brighter: the median over some
/// cells. 1 if most of the first is too dark to tell.
float gain_between(const SmallPicture& before, const SmallPicture& now);

/// Remembers gain_between() of the last pictures, for several checks ask for it.
class LastGain {
 public:
  float between(const std::shared_ptr<const SmallPicture>& before,
                const std::shared_ptr<const SmallPicture>& now);

 private:
  std::shared_ptr<const SmallPicture> before_, now_;
  float gain_ = 1;
};

}  // namespace internal
}  // namespace hypotrack
