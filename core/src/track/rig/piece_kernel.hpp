#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

inline constexpr int kPieceSide = 12;  ///< pixels of a square piece of a picture

/// Levels of a piece of a grey picture, row by row, less their rounded mean.
struct Piece {
  /// @param pixels its first one
  /// @param stride bytes from row to row
  Piece(const std::uint8_t* pixels, std::ptrdiff_t stride);

  std::array<float, std::size_t{kPieceSide} * kPieceSide> levels;
  float mean;  ///< of the levels: at most 0.5, for they are whole numbers
  float norm;  ///< of the levels less their mean
};

/// Writes the correlations, -1 .. 1, of a piece with each piece of a row of them. Differences below
/// a level count as noise. SIMD, the same on all instruction sets but for rounding.
/// @param pixels of kPieceSide rows of likeness.size() + kPieceSide - 1
void correlate(const Piece& piece, const std::uint8_t* pixels, std::ptrdiff_t stride,
               std::span<float> likeness);

/// Writes the sums of absolute differences of each column of kPieceSide rows of two pictures, which
/// have the same stride.
void sum_changes(const std::uint8_t* a, const std::uint8_t* b, std::ptrdiff_t stride,
                 std::span<std::uint16_t> sums);

}  // namespace internal
}  // namespace hypotrack
