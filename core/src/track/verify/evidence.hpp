#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string_view>

#include "base/exported.hpp"
#include "track/verify/foreground_colors.hpp"
#include "track/verify/surface_samples.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Image measurements of one model in one frame: how well the pictures support its pose.
struct Evidence {
  /// Index of each measurement in `values`.
  enum Index {
    kCorrelation,     ///< correlation of the two views' colours over the surface, -1 .. 1
    kTexture,         ///< kCorrelation after subtraction of local means, -1 .. 1
    kAgreement,       ///< share of the surface whose patches correlate by more than half
    kContrast,        ///< local contrast of the surface: log10 of the standard deviation, 0 .. 255
    kDifference,      ///< median distance of the two views' colours, log10 of 0 .. 255
    kRingTexture,     ///< kTexture beside the silhouette, at the model's depth
    kRingDifference,  ///< kDifference beside the silhouette, at the model's depth
    kSeparation,  ///< distance of the colour histograms inside and beside the silhouette, 0 .. 1
    kEdges,       ///< share of the silhouette on colour edges, smaller of both views
    kEdgeRatio,   ///< log10 of the colour change at it over changes nearby, smaller of both views
    kInside,      ///< mean foreground probability of the surface, 0 .. 1; 0.5: unknown
    kRing,        ///< mean foreground probability beside the silhouette
    kPaired,      ///< share of the surface that both views show
    kVisible,     ///< share of the model's vertices inside both pictures
    kWorstAgreement,  ///< kAgreement of the worst pieces
    kWorstInside,     ///< kInside of the worst pieces
    kWorstRing,       ///< kRing of the worst pieces beside the silhouette
    kWorstEdges,      ///< kEdges of the worst sector of the silhouette
    kCount
  };
  std::array<double, kCount> values{};
  double likeness = std::numeric_limits<double>::quiet_NaN();  ///< Appearance::likeness()
  double covered = 0;  ///< share of the model's drawn points that other models hide
  int points = 0;      ///< grid points that show it in the first view
  bool known = false;  ///< false: nothing could be measured

  double operator[](Index i) const { return values[i]; }
};

/// Returns the names of the measurements, for tables.
std::array<std::string_view, Evidence::kCount> evidence_names();

/// Measures how well the samples support the model's pose. `colors` gives the foreground
/// probabilities, 0.5 before anything was learned.
Evidence measure(const SurfaceSamples& samples, const ForegroundColors& colors);

}  // namespace internal
}  // namespace hypotrack
