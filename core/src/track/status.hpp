#pragma once

#include <deque>
#include <string_view>

#include "hypotrack/export.hpp"
#include "hypotrack/params.hpp"

namespace hypotrack {

enum class Status {
  tracked,    ///< the cost is what the last frames lead to expect
  uncertain,  ///< the cost is an outlier, or part of the scene is out of view
  lost,       ///< out of view, infeasible, or uncertain for too long
  missing,    ///< there was no usable frame; the state is the last one
};
HYPOTRACK_API std::string_view to_string(Status status);

/// `tracker:` of a scene.
struct StatusSettings {
  int history = 30;
  double outlier = 6.0;
  int patience = 15;
  double min_visible = 0.3;
  void visit(ParamVisitor& v) {
    v("history", history,
      {.help = "past frames whose costs say what to expect", .min = 5, .max = 10000});
    v("outlier", outlier,
      {.help = "uncertain above median + this many robust standard deviations of those costs",
       .min = 1,
       .max = 1000});
    v("patience", patience,
      {.help = "uncertain frames in a row that make lost", .min = 1, .max = 100000});
    v("min_visible", min_visible,
      {.help = "lost below this share of the models inside every image; uncertain below twice it",
       .min = 0,
       .max = 0.5});
  }
};

/// Judges solutions by what can be seen without the truth: cost against the recent past, and how
/// much of the models is in view. It cannot tell a wrong pose that explains the images well.
class HYPOTRACK_API StatusMonitor {
 public:
  explicit StatusMonitor(const StatusSettings& settings) : settings_(settings) {}

  /// `visible` is the share of the models' vertices that project into every image.
  Status judge(double cost, double visible);

 private:
  bool is_outlier(double cost) const;
  StatusSettings settings_;
  std::deque<double> costs_;  ///< of past frames, newest last
  int uncertain_in_a_row_ = 0;
};

}  // namespace hypotrack
