#pragma once

#include <filesystem>

#include "hypotrack/plugin/params.hpp"

namespace hypotrack::landmarks {

struct LandmarksParams {
  double sigma = 0.02;
  double free = 0.01;
  double least_presence = 0.5;
  double presence_power = 1;
  std::filesystem::path folder;
  bool lite = false;
  void visit(ParamVisitor& v) {
    v("sigma_mm", sigma,
      {.help = "distance beyond `free_mm` at which a landmark costs half of its maximum",
       .min = 0.1,
       .max = 1000,
       .unit = "mm",
       .to_si = kMillimetre});
    v("free_mm", free,
      {.help = "distance from the detected landmark at no cost, because the detector's joints are "
               "not quite the model's",
       .min = 0,
       .max = 1000,
       .unit = "mm",
       .to_si = kMillimetre});
    v("least_presence", least_presence,
      {.help = "least probability of a hand, by the detector", .min = 0, .max = 1});
    v("presence_power", presence_power,
      {.help = "a hand's weight is its probability to this power; 0: all hands weigh the same",
       .min = 0,
       .max = 1000});
    v("folder", folder,
      {.help = "folder of the detector; default: where `hypotrack get detector` puts it"});
    v("lite", lite, {.help = "smaller networks: quicker, less accurate"});
  }
};

}  // namespace hypotrack::landmarks
