#pragma once

#include <filesystem>

#include "hypotrack/plugin/params.hpp"

namespace hypotrack::contour {

/// Settings of the contours that are drawn once per model.
struct ViewSettings {
  int subdivisions = 4;
  int points = 200;
  void visit(ParamVisitor& v) {
    v("subdivisions", subdivisions,
      {.help = "of the icosahedron whose corners are the directions from which models are drawn: "
               "2 gives 162, 3 gives 642, 4 gives 2562",
       .min = 0,
       .max = 5});
    v("points", points,
      {.help = "correspondence lines per model and view", .min = 20, .max = 2000});
  }
};

/// Parameters of `type: contour`.
struct Params {
  ViewSettings views;
  std::filesystem::path cache;
  double learning_rate = 0.2;
  double depth_sigma = 0;
  void visit(ParamVisitor& v) {
    views.visit(v);
    v("cache", cache,
      {.help = "folder for the models' contours; default: hypotrack/contours in XDG_CACHE_HOME or "
               "~/.cache"});
    v("learning_rate", learning_rate,
      {.help = "weight of the last frame's colours in the histograms", .min = 0, .max = 1});
    v("depth_sigma_mm", depth_sigma,
      {.help = "standard deviation of measured depth, against which the surfaces are fitted, too; "
               "0: depth is not looked at",
       .min = 0,
       .max = 1000,
       .unit = "mm",
       .to_si = kMillimetre});
  }
};

}  // namespace hypotrack::contour
