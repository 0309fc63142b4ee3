#pragma once

#include <optional>

#include "hypotrack/export.hpp"
#include "tile/color_map.hpp"
#include "track/color/color_samples.hpp"

namespace hypotrack {

/// The map that makes the other view's colours the first's, from samples of both at the same
/// points. Their distributions are brought together, not single samples: a pose that is somewhat
/// wrong shifts the samples against each other and leaves the distributions nearly alike, and noise
/// does not flatten the line. Per channel a line through the deciles, found again without the pairs
/// that are far from it; where the deciles span little, it tends to a pure gain. Nothing if there
/// are under 100 samples that are neither dark nor saturated, if the pairs scatter by more than a
/// fifth of their brightness around the map, or if no camera pair would differ that much.
HYPOTRACK_API std::optional<ColorMap> fit_color_map(const ColorSamples& samples);

/// Pearson's correlation of the two views' samples, the mean over the channels that vary in both:
/// near 1 where both show the same points, near 0 where they show points of their own. 0 if no
/// channel varies.
HYPOTRACK_API double correlation(const ColorSamples& samples);

/// Median distance of the samples once the other view's are mapped: the Euclidean norm of colours
/// in 0..1; 0 without samples.
HYPOTRACK_API double median_difference(const ColorSamples& samples, const ColorMap& map);

/// How much brighter the first view is than the other's mapped colours, mean of the channels (N).
HYPOTRACK_API Eigen::VectorXf gray_difference(const ColorSamples& samples, const ColorMap& map);

}  // namespace hypotrack
