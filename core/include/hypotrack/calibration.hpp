#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/params.hpp"

namespace hypotrack {

enum class LengthUnit { m, cm, mm };
HYPOTRACK_API std::span<const std::string_view> enum_names(LengthUnit);
/// Returns the length of a unit in metres.
HYPOTRACK_API double metres_per(LengthUnit unit);
HYPOTRACK_API std::span<const std::string_view> enum_names(DistortionModel);

/// Parameters of a source's `calibration:` section, which names an OpenCV YAML file of one of three
/// forms. Matrices are OpenCV's (`!!opencv-matrix`) or plain lists of numbers.
///
/// 1. Stereo, as OpenCV's stereo_calib writes it, in one file or two: M1 D1 M2 D2 and R T with
///    p_second = R p_first + T. (K1/K2 or cameraMatrix1/2 for M, distCoeffs1/2 for D are fine.)
/// 2. One camera, as OpenCV's calibration program writes it: camera_matrix,
///    distortion_coefficients.
/// 3. Any number of cameras, in hypotrack's own form:
///
///      %YAML:1.0
///      ---
///      units: m            # of T: m, cm or mm
///      cameras:
///        - image_width: 1280
///          image_height: 720
///          model: brown    # none, brown (4, 5 or 8 coefficients) or fisheye (4)
///          K: [fx, 0, cx, 0, fy, cy, 0, 0, 1]
///          D: [k1, k2, p1, p2, k3]
///          R: [1, 0, 0, 0, 1, 0, 0, 0, 1]    # p_camera = R p_world + T
///          T: [0, 0, 0]
///
/// image_width and image_height (or imageSize) may also stand at the top of forms 1 and 2.
struct CalibrationSettings {
  std::filesystem::path file;
  std::filesystem::path extrinsics;
  std::optional<LengthUnit> units;
  double scale = 1;
  std::vector<double> image_size;
  std::optional<DistortionModel> model;
  bool any_baseline = false;

  void visit(ParamVisitor& v) {
    v("file", file, {.help = "OpenCV YAML with the cameras", .required = true});
    v("extrinsics", extrinsics, {.help = "second file with R and T, as stereo_calib writes it"});
    v("units", units,
      {.help = "unit of the translations in the file: m, cm or mm (default: what the file says "
               "under `units`, otherwise m)"});
    v("scale", scale,
      {.help = "further factor on the translations: the side of a checkerboard square, in `units`, "
               "where the calibration was made in squares",
       .min = 1e-9,
       .max = 1e9});
    v("image_size", image_size,
      {.help = "width and height where the file does not say (default: those of the images)",
       .min = 1,
       .max = 65536,
       .unit = "px"});
    v("model", model,
      {.help = "lens model where the file does not say: none, brown or fisheye (default: brown)"});
    v("any_baseline", any_baseline,
      {.help = "accept cameras less than 5 mm or more than 2 m apart"});
  }
};

/// Loads the cameras of a calibration file. The first camera is the world unless the file gives it
/// a pose (form 3). A camera's width and height are 0 if neither file nor settings give them;
/// fit_image_size() then sets them.
/// Throws DataError, naming file and line, on unreadable files, XML, JSON, missing matrices, wrong
/// sizes and NaN. It also rejects skewed or upside-down intrinsics, an R that is not a rotation and
/// unsupported numbers of distortion coefficients. Baselines must be plausible, which detects
/// millimetres read as metres.
HYPOTRACK_API std::vector<Camera> load_calibration(const CalibrationSettings& settings);

/// Sets a camera's size to that of its images. Throws DataError, naming `where`, if the camera is
/// calibrated for another size.
HYPOTRACK_API void fit_image_size(Camera& camera, int width, int height, std::string_view where);

}  // namespace hypotrack
