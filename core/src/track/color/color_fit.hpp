#pragma once

#include <optional>

#include "base/exported.hpp"
#include "tile/color_map.hpp"
#include "track/color/color_samples.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Estimates the map from the other view's colours to the first's, from samples at the same points.
/// Matches the two distributions instead of single samples: a slightly wrong pose shifts the
/// samples against each other but hardly changes the distributions, and noise does not flatten the
/// line.
///
/// Fits per channel a line through the deciles, then refits it without outlying pairs. Where the
/// deciles span little, the line tends to a pure gain.
///
/// Returns nothing in three cases: a channel has fewer than 100 samples that are neither dark nor
/// saturated; the pairs scatter around the line by more than a fifth of their brightness; the line
/// is implausible for a pair of cameras.
std::optional<ColorMap> fit_color_map(const ColorSamples& samples);

/// Computes Pearson's correlation of the two views' samples, the mean over the channels that vary
/// in both. It is near 1 if both views show the same points, near 0 if they show different ones,
/// and 0 if no channel varies.
double correlation(const ColorSamples& samples);

/// Computes the median distance of the samples after mapping the other view's colours. The distance
/// is the Euclidean norm of colours in 0..1; 0 without samples.
double median_difference(const ColorSamples& samples, const ColorMap& map);

/// Computes how much brighter the first view is than the other's mapped colours, averaged over the
/// channels, for each of N samples (0 .. 255).
Eigen::VectorXf gray_difference(const ColorSamples& samples, const ColorMap& map);

}  // namespace internal
}  // namespace hypotrack
