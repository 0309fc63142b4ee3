#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// What shapes are estimated from.
enum class ShapeFrom {
  images,   ///< all shape parameters, by tracking and fitting in turn
  starters  ///< the scale, as starters that look for the models see it
};
inline std::span<const std::string_view> enum_names(ShapeFrom) {
  static constexpr std::array<std::string_view, 2> kNames = {"images", "starters"};
  return kNames;
}

/// `shape:` of a scene: how shapes are estimated.
struct ShapeEstimateSettings {
  double seconds = 0;
  ShapeFrom from = ShapeFrom::images;
  std::vector<std::string> models;
  std::vector<std::string> parameters;
  int frames = 16;
  int rounds = 2;
  int iterations = 8;
  double coverage = 0.15;
  double prior = 0.3;
  void visit(ParamVisitor& v) {
    v("estimate_s", seconds,
      {.help = "`run` holds the frames of this time back, fits the shape to them and then tracks "
               "with it from the first; 0: it takes the shapes as they are given",
       .min = 0,
       .max = 60,
       .unit = "s"});
    v("from", from,
      {.help = "images: fits all parameters while tracking; starters: takes the scale "
               "that starters in init.from see, if they detect the models"});
    v("models", models, {.help = "models of one shape; default: all that have shape parameters"});
    v("parameters", parameters, {.help = "parameters to estimate; default: all shape parameters"});
    v("frames", frames, {.help = "frames that are fitted together", .min = 2, .max = 1000});
    v("rounds", rounds, {.help = "alternations of tracking and fitting", .min = 1, .max = 20});
    v("iterations", iterations, {.help = "steps of each joint fit", .min = 1, .max = 1000});
    v("coverage", coverage,
      {.help = "least contribution of a covered pixel, relative to the mean one; 0: sizes grow "
               "wherever anything looks alike",
       .min = 0,
       .max = 1});
    v("prior", prior,
      {.help = "prior cost per frame of one standard deviation from the neutral shape, in pixels",
       .min = 0,
       .max = 1e6});
  }
};

}  // namespace internal
}  // namespace hypotrack
