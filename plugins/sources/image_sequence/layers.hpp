#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/stereo_layout.hpp"
#include "hypotrack/plugin/params.hpp"
#include "hypotrack/plugin/truth.hpp"
#include "timestamps.hpp"

namespace hypotrack {

struct ImageSequenceParams {
  std::filesystem::path left;
  std::filesystem::path right;
  std::filesystem::path left_mask;
  std::filesystem::path right_mask;
  std::filesystem::path left_depth;
  std::filesystem::path right_depth;
  std::optional<StereoLayout> layout;
  double depth_unit = kMillimetre;
  CalibrationSettings calibration;
  std::optional<int> start;
  int step = 1;
  std::optional<int> count;
  std::optional<double> frame_rate;
  TimestampSettings timestamps;
  std::optional<int> bits;
  TruthSettings truth;

  void visit(ParamVisitor& v) {
    v("left", left,
      {.help = "images of the first camera: left_%04d.png (numbers; gaps are reported), left_*.png "
               "(sorted, 9 before 10) or one file; not needed where there is left_depth"});
    v("right", right,
      {.help = "images of the second camera; without it and right_depth there is one view"});
    v("left_mask", left_mask, {.help = "foreground of the first camera: not zero is foreground"});
    v("right_mask", right_mask, {.help = "foreground of the second camera"});
    v("left_depth", left_depth,
      {.help = "depth along the axis of the first camera: 16-bit PNG, 0 is not measured"});
    v("right_depth", right_depth, {.help = "depth of the second camera"});
    v("layout", layout,
      {.help = "left, left_mask and left_depth hold both views, and there is no right; the first "
               "camera is in the left half (side_by_side) or the upper half (top_bottom)"});
    v("depth_units_mm", depth_unit,
      {.help = "depth that one unit of left_depth and right_depth means",
       .min = 1e-4,
       .max = 1e3,
       .unit = "mm",
       .to_si = kMillimetre});
    v("calibration", calibration, {.help = "the cameras", .required = true});
    v("start", start,
      {.help = "number (with %d) or position (with *) of the first frame; default: the first found",
       .min = 0});
    v("step", step, {.help = "take every step-th image", .min = 1, .max = 1000000});
    v("count", count, {.help = "number of frames; default: all", .min = 1, .max = 10000000});
    v("frame_rate", frame_rate,
      {.help = "images per second of the recording; default: 30, or as the time stamps have it",
       .min = 1e-3,
       .max = 1e5,
       .unit = "1/s"});
    v("timestamps", timestamps,
      {.help = "times of the images, if their rate is not constant; gaps then keep their length"});
    v("bits", bits,
      {.help = "significant bits of 16-bit images; default: 16", .min = 8, .max = 16});
    truth.visit(v);
  }
};

enum class Content { color, mask, depth };

/// One of the pictures that make up a frame.
struct Layer {
  std::size_t view;
  Content content;
  std::filesystem::path pattern;
};

/// Throws ConfigError, naming `where`, if the patterns make no views.
void check_patterns(const ImageSequenceParams& params, const std::string& where);

/// Returns the layers that are given.
std::vector<Layer> layers_of(const ImageSequenceParams& params);

}  // namespace hypotrack
