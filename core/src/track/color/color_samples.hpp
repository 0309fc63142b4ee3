#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "tile/resample.hpp"
#include "track/color/highlights.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Colours of two views at the same surface points: blue, green and red, 0 .. 255.
struct ColorSamples {
  std::array<std::vector<float>, 3> first, other;
  Eigen::Matrix3Xf normals;  ///< surface normals, outwards, in the world; only if asked for

  std::size_t size() const { return first[0].size(); }
};

/// Samples the colours of a posed scene where two views see the same surface. Reads the images
/// themselves, so that the result does not depend on the backend, or tiles that were kept.
class ColorSampler {
 public:
  /// The scene must outlive the sampler.
  explicit ColorSampler(const Scene& scene);
  ~ColorSampler();

  /// Draws the scene in a normalised state through the cameras of a frame's tiles, on a 64 x 64
  /// grid. Uses only the header's cameras. The header must outlive the sampling.
  void draw(const Observation& header, const Eigen::VectorXd& state);

  /// Samples the first view and view `other` (from 1 on) where both see the same surface. Takes
  /// every second grid point, like the black squares of a chessboard, away from the edges of what
  /// is drawn. `cameras` has one entry per view. Returns no samples if a view has no colour.
  ColorSamples take(const Frame& frame, std::span<const Resampler> cameras, std::size_t other,
                    bool with_normals = false) const;
  /// Samples tiles instead of images. They must be those whose cameras draw() was given.
  ColorSamples take(const Observation& tiles, std::size_t other, bool with_normals = false) const;

  /// Surface normals of a drawn view.
  struct NormalGrid {
    cv::Mat inside;            ///< 8-bit, 64 x 64: where normals are known, away from edges
    Eigen::Matrix3Xf normals;  ///< of those points, row by row; outwards, in the world
  };
  NormalGrid normals(std::size_t view) const;

  /// Returns the directions from the centre of the drawn surface to the first view's camera and
  /// another's.
  ViewDirections directions(std::size_t other) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Extrapolates values of grid points to a whole tile by normalised Gaussian blurring. The values
/// belong to the `inside` points (8-bit), row by row. Returns an image of the tile's size (32-bit
/// float).
cv::Mat extrapolate(const cv::Mat& inside, const Eigen::VectorXf& values, cv::Size tile);

}  // namespace internal
}  // namespace hypotrack
