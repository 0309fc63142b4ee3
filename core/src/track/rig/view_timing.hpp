#pragma once

#include <deque>
#include <optional>

#include "base/exported.hpp"
#include "track/rig/rectified_pair.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Tells by how many frames the second view of a pair is late. It compares small pieces of the
/// first picture that move with the same rows of the second view's pictures of several frames: they
/// are most alike in the picture of their moment.
class ViewTiming {
 public:
  static constexpr int kMostLate = 2;  ///< frames: it cannot tell longer delays apart

  /// What one frame tells.
  struct Peak {
    double frames = 0;  ///< by which the second view is late
    double gain = 0;    ///< likeness of the views then, above that without a delay
  };

  /// `disparity`: the largest one, in pixels of the small pictures.
  explicit ViewTiming(double disparity) : disparity_(disparity) {}

  /// Takes the pictures of the next frame.
  void add(const GreyPair& pictures);
  /// Forgets the pictures and what they told.
  void restart();

  /// Returns by how many frames the second view is late, negative for the first, if the last frames
  /// that told something agree.
  std::optional<double> late() const;
  /// Returns the number of frames since restart(), and of those that told something.
  int taken() const { return taken_; }
  int told() const { return told_; }

 private:
  /// Returns the median of the last frames that told something, if all but some are near it.
  std::optional<double> agreed(std::size_t count, std::size_t wrong) const;

  double disparity_;
  std::deque<GreyPair> recent_;
  std::deque<Peak> found_;  ///< by the last frames that told something
  int taken_ = 0, told_ = 0;
};

}  // namespace internal
}  // namespace hypotrack
