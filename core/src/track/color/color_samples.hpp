#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/observation.hpp"
#include "hypotrack/scene.hpp"
#include "tile/resample.hpp"
#include "track/color/highlights.hpp"

namespace hypotrack {

/// What two views show at the same points of a surface: blue, green and red, 0 .. 255.
struct ColorSamples {
  std::array<std::vector<float>, 3> first, other;
  Eigen::Matrix3Xf normals;  ///< of the surface there, outwards, in the world; if asked for

  std::size_t size() const { return first[0].size(); }
};

/// Looks up the colours of a posed scene where two views see the same of it: in the images
/// themselves, so that it does the same wherever hypotheses are evaluated, or in tiles that were
/// kept.
class HYPOTRACK_API ColorSampler {
 public:
  /// The scene must outlive the sampler.
  explicit ColorSampler(const Scene& scene);
  ~ColorSampler();

  /// Draws the scene in a normalised state into the cameras of a frame's tiles, on a grid of 64 x
  /// 64. Only the header's cameras are looked at; it must outlive the sampling.
  void draw(const Observation& header, const Eigen::VectorXd& state);

  /// Samples of the first view and view `other` (from 1 on) at every second point of the grid, as
  /// the black squares of a chessboard, where both see the same, away from the edges of what is
  /// drawn. `cameras` are one per view. None if a view has no colour.
  ColorSamples take(const Frame& frame, std::span<const Resampler> cameras, std::size_t other,
                    bool with_normals = false) const;
  /// The same of tiles, those that draw() was given the cameras of.
  ColorSamples take(const Observation& tiles, std::size_t other, bool with_normals = false) const;

  /// Normals of what a view is drawn to show.
  struct NormalGrid {
    cv::Mat inside;            ///< 8-bit, 64 x 64: where they are known, away from edges
    Eigen::Matrix3Xf normals;  ///< of those points, row by row; outwards, in the world
  };
  NormalGrid normals(std::size_t view) const;

  /// From the middle of what the first view is drawn to show to that view's camera and another's.
  ViewDirections directions(std::size_t other) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
