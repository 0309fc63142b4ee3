#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string_view>

#include "hypotrack/export.hpp"
#include "track/judge/foreground_colors.hpp"
#include "track/judge/surface_samples.hpp"

namespace hypotrack {

/// Measurements of one model in one frame: how well the pictures show it where it was found.
struct Evidence {
  /// What is measured, in the order of `values`.
  enum Index {
    kCorrelation,     ///< of the two views' colours over its surface, -1 .. 1
    kTexture,         ///< the same after local means were taken off, -1 .. 1
    kAgreement,       ///< share of its surface whose patches correlate by more than half
    kContrast,        ///< local contrast of its surface: log10 of the standard deviation, 0 .. 255
    kDifference,      ///< median distance of the two views' colours, log10 of 0 .. 255
    kRingTexture,     ///< kTexture beside the silhouette, at the model's depth
    kRingDifference,  ///< kDifference beside the silhouette, at the model's depth
    kSeparation,      ///< distance of the colours inside and beside the silhouette, 0 .. 1
    kEdges,           ///< share of the silhouette where colours change, smaller of both views
    kEdgeRatio,       ///< log10 of that change over changes nearby, smaller of both views
    kInside,          ///< mean foreground probability of its surface, 0 .. 1; 0.5: unknown
    kRing,            ///< the same beside its silhouette
    kPaired,          ///< share of its surface that both views show
    kVisible,         ///< share of it inside both pictures
    kWorstAgreement,  ///< kAgreement of its worst pieces
    kWorstInside,     ///< kInside of its worst pieces
    kWorstRing,       ///< kRing of the worst pieces beside its silhouette
    kWorstEdges,      ///< kEdges of the worst sector of its silhouette
    kCount
  };
  std::array<double, kCount> values{};
  double likeness = std::numeric_limits<double>::quiet_NaN();  ///< Appearance::likeness()
  double covered = 0;  ///< share of its drawn points that other models hide
  int points = 0;      ///< of the grid that show it in the first view
  bool known = false;  ///< false: nothing could be measured

  double operator[](Index i) const { return values[i]; }
};

/// Names of the measurements, for tables.
HYPOTRACK_API std::array<std::string_view, Evidence::kCount> evidence_names();

/// Measures what samples show. `colors` are the foreground's as far as they are known.
HYPOTRACK_API Evidence measure(const SurfaceSamples& samples, const ForegroundColors& colors);

}  // namespace hypotrack
