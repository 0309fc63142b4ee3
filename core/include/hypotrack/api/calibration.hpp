#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/export.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {

enum class LengthUnit { m, cm, mm };
HYPOTRACK_API std::span<const std::string_view> enum_names(LengthUnit);
/// Returns the length of a unit in metres.
HYPOTRACK_API double metres_per(LengthUnit unit);
HYPOTRACK_API std::span<const std::string_view> enum_names(DistortionModel);

/// Parameters of a source's `calibration:` section. The content of the file says which of these it
/// is (docs/reference/recordings.md shows hypotrack's own):
///
/// - hypotrack's: any number of cameras, YAML.
/// - OpenCV's YAML or JSON: of stereo_calib, in one file or two, or of one camera.
/// - Kalibr's camchain.
/// - a ZED's factory calibration, SN*.conf, which has cameras for several sizes of pictures.
/// - camera_info of ROS, a file for each camera.
/// - depthai's export of the memory of an OAK camera.
/// - settings of ORB-SLAM 2 or 3.
/// - sensor.yaml of EuRoC, a file for each camera.
/// - TOML of caliscope or anipose.
struct CalibrationSettings {
  std::filesystem::path file;
  std::filesystem::path second = {};
  std::filesystem::path extrinsics = {};
  std::vector<std::string> cameras = {};
  std::optional<LengthUnit> units = {};
  double scale = 1;
  std::vector<double> image_size = {};
  std::optional<DistortionModel> model = {};
  bool any_baseline = false;

  void visit(ParamVisitor& v) {
    v("file", file,
      {.help = "calibration of hypotrack, OpenCV, Kalibr, ROS, ZED, depthai, ORB-SLAM, EuRoC, "
               "caliscope "
               "or anipose",
       .required = true});
    v("second", second, {.help = "file of the second camera, where each has its own, as in ROS"});
    v("extrinsics", extrinsics, {.help = "second file with R and T, as stereo_calib writes it"});
    v("cameras", cameras,
      {.help = "which cameras of the file, by name, first and second view (default: all)"});
    v("units", units,
      {.help = "unit of the translations in the file: m, cm or mm (default: `units` of the file, "
               "else m; mm for a ZED, cm for depthai)"});
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

/// Width and height of pictures; zeros: unknown.
struct ImageSize {
  int width = 0;
  int height = 0;
};

/// A camera and what its calibration calls it.
struct NamedCamera {
  std::string name;
  Camera camera;
};

/// Cameras and the format of the file that they come from.
struct Calibration {
  std::string format;
  std::vector<NamedCamera> cameras;
  std::vector<std::string> notes = {};  ///< lines for the user, such as what was not understood
};

/// Reads a calibration file. The first camera is the world unless the file gives it a pose. A
/// camera's width and height are 0 if neither file nor settings give them; fit_image_size() then
/// sets them. `pictures` chooses between resolutions where a file has several.
/// Throws DataError, naming file and line, on unreadable files, other XML than OpenCV's, missing
/// matrices, wrong sizes and NaN. It also rejects skewed or upside-down intrinsics, an R that is
/// not a rotation and unsupported lens models. Baselines must be plausible, which detects
/// millimetres read as metres.
HYPOTRACK_API Calibration read_calibration(const CalibrationSettings& settings,
                                           const ImageSize& pictures = {});

/// Returns the cameras of read_calibration(), whose notes go to `notes` if it is given.
HYPOTRACK_API std::vector<Camera> load_calibration(const CalibrationSettings& settings,
                                                   const ImageSize& pictures = {},
                                                   std::vector<std::string>* notes = nullptr);

/// Sets a camera's size to that of its images. Throws DataError, naming `where`, if the camera is
/// calibrated for another size.
HYPOTRACK_API void fit_image_size(Camera& camera, int width, int height, std::string_view where);

}  // namespace hypotrack
