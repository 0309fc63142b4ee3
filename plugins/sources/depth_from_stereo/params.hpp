#pragma once

#include <array>
#include <span>
#include <string_view>

#include "hypotrack/plugin/params.hpp"

namespace hypotrack::depth_from_stereo {

enum class Mode { five_ways, eight_ways, three_ways };
inline std::span<const std::string_view> enum_names(Mode) {
  static constexpr std::array<std::string_view, 3> kNames = {"five_ways", "eight_ways",
                                                             "three_ways"};
  return kNames;
}

struct Params {
  ConfigNode source;
  double nearest = 0.3;
  double farthest = 2.0;
  int block_size = 5;
  Mode mode = Mode::five_ways;
  double smoothness = 1;
  int uniqueness = 10;
  int consistency = 1;
  int speckle_size = 100;
  int speckle_range = 2;

  void visit(ParamVisitor& v) {
    v("source", source,
      {.help = "{type, ...}: a source with two calibrated cameras", .required = true});
    v("nearest_mm", nearest,
      {.help = "nearest depth; nearer points get no depth, or a wrong one",
       .min = 10,
       .max = 1e5,
       .unit = "mm",
       .to_si = kMillimetre});
    v("farthest_mm", farthest,
      {.help = "farthest depth; points beyond it get no depth, or a wrong one",
       .min = 11,
       .max = 1e6,
       .unit = "mm",
       .to_si = kMillimetre});
    v("block_size", block_size,
      {.help = "side of the compared squares, odd", .min = 1, .max = 21, .unit = "px"});
    v("mode", mode,
      {.help = "along how many directions costs are summed: five; eight (better, slower); three "
               "(fastest, streaks)"});
    v("smoothness", smoothness,
      {.help = "factor on the penalties of OpenCV's samples for disparities that differ between "
               "neighbours",
       .min = 0,
       .max = 100});
    v("uniqueness", uniqueness,
      {.help = "by how much the best disparity must beat every other, otherwise there is no depth",
       .min = 0,
       .max = 100,
       .unit = "%"});
    v("consistency", consistency,
      {.help = "largest difference between matching left to right and right to left; -1: no check",
       .min = -1,
       .max = 100,
       .unit = "px"});
    v("speckle_size", speckle_size,
      {.help = "patches of depth smaller than this are dropped; 0: none are",
       .min = 0,
       .max = 100000,
       .unit = "px"});
    v("speckle_range", speckle_range,
      {.help = "neighbours of one patch differ by at most this disparity",
       .min = 1,
       .max = 100,
       .unit = "px"});
  }
};

}  // namespace hypotrack::depth_from_stereo
