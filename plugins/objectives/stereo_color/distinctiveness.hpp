#pragma once

#include <cstdint>
#include <vector>

namespace hypotrack::stereo_color {

/// Eigenvalues of the auto-correlation matrix of a grey image, per pixel, row by row: major >=
/// minor >= 0. They are the principal curvatures of the local auto-correlation function.
struct Curvatures {
  std::vector<float> major;
  std::vector<float> minor;
};

/// Computes the eigenvalues from gradients, whose products are summed over 3x3 pixels. Gradients
/// are central differences, (right - left) / 2 and (below - above) / 2. A gradient is zero if it
/// needs a pixel outside the image or one with `valid` 0. `grey` and `valid` are width x height,
/// row by row.
Curvatures principal_curvatures(const std::vector<float>& grey,
                                const std::vector<std::uint8_t>& valid, int width, int height);

/// Computes the paper's distinctiveness map c in 0..1, from d = log sqrt(major^2 + minor^2) and a =
/// atan2(minor, major). Each goes through a sigmoid about its exact median over the valid pixels
/// (the mean of the middle two for an even number). c = d_s a_s, or 0 where that is below w_t or
/// the pixel is invalid.
std::vector<float> distinctiveness(const Curvatures& curvatures,
                                   const std::vector<std::uint8_t>& valid, double w_t);

}  // namespace hypotrack::stereo_color
