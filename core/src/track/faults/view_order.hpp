#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "track/faults/small_picture.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Tells whether the pictures of two cameras arrive exchanged: it matches places of the first
/// picture along the epipolar lines that they have in the right order and in the wrong one.
class ViewOrder {
 public:
  ViewOrder(const Camera& first, const Camera& second) : cameras_{first, second} {}

  /// Returns whether the pictures are surely exchanged. Those of cameras of different sizes or
  /// directions cannot be.
  bool is_exchanged(const SmallPicture& first, const SmallPicture& second);

 private:
  using Cell = std::int16_t;
  /// A place of the first picture, and how many steps along both lines are in the picture.
  struct Place {
    Cell x, y;
    int steps;
    std::size_t first_step;  ///< in steps_
  };
  /// Cells of the second picture, at one inverse depth.
  struct Step {
    std::array<Cell, 2> right, exchanged;
  };

  void prepare(const SmallPicture& size);
  /// Returns the cells of `to` that show the points on a ray of `from`, from far to near.
  std::vector<std::array<Cell, 2>> line(const Camera& from, const Camera& to,
                                        const Eigen::Vector3d& ray, const SmallPicture& size) const;

  std::array<Camera, 2> cameras_;
  bool prepared_ = false;
  int width_ = 0, height_ = 0;  ///< of the small pictures that places are in
  int depths_ = 0;              ///< steps of a line
  double nearest_ = 0;          ///< largest inverse depth of a line, 1/m
  std::vector<Place> places_;
  std::vector<Step> steps_;
};

}  // namespace internal
}  // namespace hypotrack
