#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/api/export.hpp"
#include "hypotrack/plugin/params.hpp"
#include "hypotrack/plugin/plugin_object.hpp"

namespace hypotrack {

/// Version of the definitions of Measures. Weights that were fitted to one version judge no other.
inline constexpr int kMeasuresVersion = 1;

/// Measures of one model in one frame: how well the pictures support its pose. The tracker computes
/// them on the CPU, from the colours of the first two views on a grid around the model.
struct Measures {
  /// Index of each measure in `values` and `usual`.
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

  std::array<double, kCount> values{};  ///< in this frame
  std::array<double, kCount> usual{};   ///< mean of frames in which the pose was surely right
  bool experienced = false;             ///< there were such frames; without, `usual` is 0
  /// Correlation (-1 .. 1) of the surface's colours with its earlier ones; NaN: too few were seen.
  double likeness = std::numeric_limits<double>::quiet_NaN();
  double usual_likeness = 0;  ///< mean of frames in which the pose was surely right
  double covered = 0;         ///< share of the model's drawn points that others hide
  int points = 0;             ///< grid points that show it in the first view
  bool known = false;         ///< false: nothing could be measured; no judge sees that
  bool tracked = false;       ///< the model was tracked in the last frame
  std::size_t model = 0;      ///< its number in the scene

  double operator[](Index i) const { return values[i]; }
};

/// Name of a measure in files and tables, its range and its meaning.
struct MeasureInfo {
  std::string_view name, range, meaning;
};

/// Describes the measures, in the order of Measures::Index.
HYPOTRACK_API std::span<const MeasureInfo, Measures::kCount> measure_infos();

/// Probabilities between the statuses of a model. They depend on the judge, whose probabilities may
/// be too low or too high.
struct JudgeThresholds {
  double tracked_above = 0.55;
  double certain_above = 0.75;
  double first_above = 0.35;
  double confirmed_above = 0.45;
  double uncertain_above = 0.15;

  void visit(ParamVisitor& v) {
    v("tracked_above", tracked_above,
      {.help = "tracked from this probability of being right on", .min = 0, .max = 1});
    v("certain_above", certain_above,
      {.help = "the same just after a loss; less probable frames teach no colours",
       .min = 0,
       .max = 1});
    v("first_above", first_above,
      {.help = "the same before a model was ever tracked, where a start was given",
       .min = 0,
       .max = 1});
    v("confirmed_above", confirmed_above,
      {.help = "the same where searches from other starts end in the same pose",
       .min = 0,
       .max = 1});
    v("uncertain_above", uncertain_above,
      {.help = "lost below this probability", .min = 0, .max = 1});
  }
};

/// A pose of a sequence with ground truth, for fits.
struct KnownPose {
  Measures measures;
  double error = 0;       ///< mean distance of the landmarks, metres; infinite: the model was away
  bool searched = false;  ///< a search ended there; false: it was displaced from the truth
  int sequence = 0;       ///< number of the sequence
};

/// Poses that a judge is to be fitted to.
struct JudgeFit {
  std::vector<KnownPose> poses;
  double right = 0.01;  ///< metres; a pose with at most this error is right
  double wrong = 0.02;  ///< metres; one with a larger error is wrong. Others say nothing
  std::vector<std::string> models;  ///< types of the models
  std::string source;               ///< the poses in words
};

class Judge;

/// A judge that was fitted to poses, and the text of the file that repeats it.
struct FittedJudge {
  std::unique_ptr<Judge> judge;
  std::string file;
};

/// Judges from measures of the pictures whether the pose of a model is right. A plugin's Params
/// derive from JudgeThresholds, with defaults that suit the judge.
class HYPOTRACK_API Judge : public PluginObject {
 public:
  explicit Judge(const JudgeThresholds& thresholds = {}) : thresholds_(thresholds) {}
  ~Judge() override;

  /// Returns the logarithm of the odds that the pose is right. Any thread may call it. Throws
  /// PluginError, which names the judge, if that is NaN.
  double log_odds(const Measures& measures) const;
  const JudgeThresholds& thresholds() const { return thresholds_; }
  /// Fits a judge of this kind to poses. Throws PluginError if it has nothing to fit, and DataError
  /// if the poses do not suffice.
  FittedJudge fit(const JudgeFit& to) const;

 protected:
  /// Computes the logarithm of the odds p / (1 - p) of measures that are `known`: 0 for p = 0.5,
  /// infinities for 0 and 1. Equal measures get equal answers, from any thread.
  virtual double do_log_odds(const Measures& measures) const = 0;
  /// Fits a judge to poses; equal poses give an equal one. By default throws PluginError.
  virtual FittedJudge do_fit(const JudgeFit& to) const;

 private:
  JudgeThresholds thresholds_;
};

/// Returns the probability of log odds.
HYPOTRACK_API double probability_of(double log_odds);

}  // namespace hypotrack
