#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <span>

#include "region.hpp"

namespace hypotrack::hands {

/// An 8-bit picture in which hands are looked for.
struct HandPicture {
  cv::Mat pixels;  ///< BGR or grey
  /// Factors of red, green and blue from 0..255 to what networks see. They give grey pictures the
  /// shade of skin, in which more palms are found.
  std::array<float, 3> factors{};
};

/// Returns a picture with its factors; BGR pictures without colour count as grey. Throws DataError
/// for pictures that are not 8-bit BGR or grey and for empty ones.
HandPicture hand_picture(const cv::Mat& picture);

/// Writes a region as an upright square picture of `side` pixels, RGB from 0 to 1, black outside
/// the picture. The output has 3 side^2 numbers.
void write_region(const HandPicture& picture, const Region& region, int side,
                  std::span<float> output);

/// Writes a part of a picture, shrunk or enlarged into the middle of a black square picture of
/// `side` pixels, RGB from 0 to 1. The output has 3 side^2 numbers.
void write_letterbox(const HandPicture& picture, const cv::Rect& part, int side,
                     std::span<float> output);

}  // namespace hypotrack::hands
