#pragma once

#include <deque>
#include <string_view>

#include "geometry/on_foreground.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/params.hpp"
#include "track/uncertainty_settings.hpp"

namespace hypotrack {

enum class Status {
  tracked,    ///< cost and sigma are what they should be
  uncertain,  ///< the cost is an outlier, sigma is large, or part of the scene is out of view
  lost,       ///< out of view, infeasible, an outlier for too long, beside the foreground, or sigma
              ///< says anything goes
  absent,     ///< the whole pictures were searched and show no such thing
  missing,    ///< there was no usable frame; the state is the last one
};
HYPOTRACK_API std::string_view to_string(Status status);

/// `tracker:` of a scene.
struct StatusSettings {
  int history = 30;
  double outlier = 6.0;
  int patience = 15;
  double min_visible = 0.3;
  double uncertain_sigma = 0.010;
  double lost_sigma = 0.040;
  UncertaintySettings uncertainty;
  void visit(ParamVisitor& v) {
    v("history", history,
      {.help = "past frames whose costs say what to expect", .min = 5, .max = 10000});
    v("outlier", outlier,
      {.help = "uncertain above median + this many robust standard deviations of those costs",
       .min = 1,
       .max = 1000});
    v("patience", patience,
      {.help = "frames in a row with outliers, or half out of view, that make lost",
       .min = 1,
       .max = 100000});
    v("min_visible", min_visible,
      {.help = "lost below this share of the models inside every image; uncertain below twice it",
       .min = 0,
       .max = 0.5});
    v("uncertain_sigma_mm", uncertain_sigma,
      {.help = "with `uncertainty`: uncertain where a model's landmarks are expected to be off by "
               "more than this on average",
       .min = 1e-3,
       .max = 1e6,
       .unit = "mm",
       .to_si = kMillimetre});
    v("lost_sigma_mm", lost_sigma,
      {.help = "the same for lost", .min = 1e-3, .max = 1e6, .unit = "mm", .to_si = kMillimetre});
    v("uncertainty", uncertainty, {.help = "how far off each landmark may be"});
  }
};

/// Judges solutions by what can be seen without the truth: cost against the recent past, how much
/// of the models is in view, and how far off their landmarks are expected to be. It cannot tell a
/// wrong pose that explains the images as well as the right one.
class HYPOTRACK_API StatusMonitor {
 public:
  explicit StatusMonitor(const StatusSettings& settings) : settings_(settings) {}

  /// `visible` is the share of the models' vertices that project into every image, `sigma` the mean
  /// over a model's landmarks, of the model where it is largest, NaN where it is not
  /// known.
  Status judge(double cost, double visible, double sigma, OnForeground on_foreground);

  /// Above it a cost is an outlier of the recent past; -infinity before there is one.
  double usual_cost() const;

 private:
  StatusSettings settings_;
  std::deque<double> costs_;  ///< of past frames, newest last
  int uncertain_in_a_row_ = 0;
};

}  // namespace hypotrack
