#pragma once

#include <filesystem>
#include <optional>

#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/media.hpp"
#include "hypotrack/api/stereo_layout.hpp"
#include "hypotrack/plugin/params.hpp"
#include "hypotrack/plugin/truth.hpp"

namespace hypotrack {

struct VideoParams {
  std::filesystem::path left;
  std::filesystem::path right;
  std::filesystem::path side_by_side;
  std::optional<StereoLayout> layout;
  CalibrationSettings calibration;
  std::optional<int> offset;
  int start = 0;
  int step = 1;
  std::optional<int> count;
  std::optional<double> frame_rate;
  std::optional<double> tolerance;
  VideoColors colors;
  TruthSettings truth;

  void visit(ParamVisitor& v) {
    v("left", left, {.help = "video of the first camera"});
    v("right", right, {.help = "video of the second camera; without it there is one view"});
    v("side_by_side", side_by_side,
      {.help = "one video with the first camera in the left half and the second in the right half, "
               "instead of left and right"});
    v("layout", layout,
      {.help = "how `left` holds both views, instead of `right`: the first camera in its left half "
               "(side_by_side) or its upper half (top_bottom)"});
    v("calibration", calibration,
      {.help = "the cameras, of pictures as players show them", .required = true});
    v("offset", offset,
      {.help = "frame of `right` that belongs to frame 0 of `left`; negative: `right` started "
               "later; default: by the times in the files",
       .min = -1000000,
       .max = 1000000});
    v("start", start,
      {.help = "frames of `left` to leave out first, gaps counted", .min = 0, .max = 1000000000});
    v("step", step, {.help = "take every step-th frame", .min = 1, .max = 1000000});
    v("count", count, {.help = "number of frames; default: all", .min = 1});
    v("frame_rate", frame_rate,
      {.help = "frames per second, if the times in the files are wrong: frames are then paired by "
               "number",
       .min = 1e-3,
       .max = 1e5,
       .unit = "1/s"});
    v("tolerance_ms", tolerance,
      {.help = "frames of a pair differ in time by this at most; default: half a frame",
       .min = 0,
       .max = 10000,
       .unit = "ms",
       .to_si = 1e-3});
    v("color_matrix", colors.matrix,
      {.help = "matrix of the colours; default: the files' own, or that of players: bt709 for HD, "
               "bt601 for SD"});
    v("color_range", colors.range,
      {.help = "range of the samples; default: the files' own, or limited"});
    truth.visit(v);
  }
};

}  // namespace hypotrack
