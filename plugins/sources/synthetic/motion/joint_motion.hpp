#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/params.hpp"
#include "motion/script.hpp"

namespace hypotrack::synthetic {

/// `joint_file:` a table of landmarks (tables.hpp) whose motion the models follow.
struct JointFileParams {
  std::filesystem::path file;
  LengthUnit units = LengthUnit::m;
  std::vector<std::string> rename;
  int first = 0;
  int count = 0;
  double smooth = 0;
  void visit(ParamVisitor& v) {
    v("file", file, {.help = "CSV of landmarks over time, in world axes: <landmark>_x, _y, _z"});
    v("units", units, {.help = "of the file: m, cm or mm"});
    v("rename", rename,
      {.help = "`name=landmark` gives a name of the file to a landmark of the scene, `name=` drops "
               "it"});
    v("first", first, {.help = "frame of the file to begin with", .min = 0});
    v("count", count, {.help = "frames to take; 0: up to the end", .min = 0});
    v("smooth_frames", smooth,
      {.help = "sigma of a Gaussian over time that takes jitter out of the landmarks",
       .min = 0,
       .max = 100,
       .unit = "frames"});
  }
};

/// Fits the models to every row of the file (fit_landmarks(), from the row before), and reports the
/// errors on stderr. Skips rows that are missing or know less than half of a model's landmarks: the
/// motion interpolates. Throws DataError, naming the file, as read_landmarks() does, and if no row
/// knows enough of a model.
Script read_joint_file(const JointFileParams& params, const Scene& scene, double frame_rate);

}  // namespace hypotrack::synthetic
