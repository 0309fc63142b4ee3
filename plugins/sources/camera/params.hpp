#pragma once

#include <optional>
#include <string>

#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/stereo_layout.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack::live {

/// Settings of a V4L2 device; absent ones stay as they are.
struct DeviceParams {
  std::optional<int> width;
  std::optional<int> height;
  std::optional<double> fps;
  std::string pixel_format;
  std::optional<double> exposure;  ///< seconds
  std::optional<int> white_balance;

  void visit(ParamVisitor& v) {
    v("width", width,
      {.help = "width of a device's picture, of both views together if it has both",
       .min = 2,
       .max = 65536,
       .unit = "px"});
    v("height", height,
      {.help = "height of a device's picture", .min = 1, .max = 65536, .unit = "px"});
    v("fps", fps,
      {.help = "pictures per second; sets a V4L2 device to it (default: the device's rate, or the "
               "measured one)",
       .min = 0.1,
       .max = 2000,
       .unit = "1/s"});
    v("pixel_format", pixel_format,
      {.help = "four letters of a V4L2 format; most webcams need MJPG for their full rate"});
    v("exposure_ms", exposure,
      {.help = "exposure of a V4L2 device, which ends its automatic exposure",
       .min = 0.1,
       .max = 10000,
       .unit = "ms",
       .to_si = 1e-3});
    v("white_balance", white_balance,
      {.help = "colour temperature for a V4L2 device, which ends its automatic white balance",
       .min = 1000,
       .max = 20000,
       .unit = "K"});
  }
};

struct Params {
  std::string device;
  std::string left;
  std::string right;
  StereoLayout layout = StereoLayout::side_by_side;
  DeviceParams settings;
  bool uncalibrated = false;
  CalibrationSettings calibration;
  std::optional<double> tolerance;  ///< seconds
  double timeout = 2;               ///< seconds
  double give_up = 30;              ///< seconds

  void visit(ParamVisitor& v) {
    v("device", device,
      {.help = "device whose picture has both views: a V4L2 number or path, the URL of a stream or "
               "a GStreamer pipeline"});
    v("left", left, {.help = "device of the first camera, instead of `device`"});
    v("right", right, {.help = "device of the second camera"});
    v("layout", layout,
      {.help = "how the picture of `device` holds the views: the first camera in its left half "
               "(side_by_side) or its upper half (top_bottom)"});
    settings.visit(v);
    v("uncalibrated", uncalibrated,
      {.help = "give pictures without a calibration, from which nothing can be tracked; for "
               "`hypotrack calibrate`"});
    v("calibration", calibration, {.help = "the cameras", .required = !uncalibrated});
    v("tolerance_ms", tolerance,
      {.help = "largest time between the two pictures of a pair; default: 0.6 of the time between "
               "pictures",
       .min = 0,
       .max = 10000,
       .unit = "ms",
       .to_si = 1e-3});
    v("timeout_s", timeout,
      {.help = "time without a pair after which a frame is missing, and without a picture after "
               "which a stream is opened again",
       .min = 0.05,
       .max = 3600,
       .unit = "s"});
    v("give_up_s", give_up,
      {.help = "time without a pair that ends the run", .min = 0.1, .max = 1e6, .unit = "s"});
  }
};

}  // namespace hypotrack::live
