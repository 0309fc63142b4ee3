// Calibration files of every format, as one file, as one of two and as one with extrinsics.

#include "hypotrack/api/calibration.hpp"

#include "target.hpp"

namespace hypotrack::fuzz {
namespace {

void read_cameras(const CalibrationSettings& settings, const ImageSize& pictures) {
  for (const NamedCamera& named : read_calibration(settings, pictures).cameras) {
    Camera camera = named.camera;
    if (camera.width == 0) fit_image_size(camera, 640, 480, "pictures");
    try {
      validate(camera, named.name);
    } catch (const Error& error) {
      throw std::logic_error(error.what());
    }
  }
}

}  // namespace

HYPOTRACK_FUZZ_TARGET(calibration, "calibration") {
  CalibrationSettings one;
  one.file = scratch_file("calibration", bytes);
  one.any_baseline = true;
  CalibrationSettings two = one, apart = one, of_size = one;
  two.second = two.file;
  apart.extrinsics = apart.file;
  apart.units = LengthUnit::mm;
  of_size.image_size = {640, 480};
  of_size.model = DistortionModel::fisheye;
  bool read = false;
  for (const CalibrationSettings& settings : {one, two, apart, of_size})
    read |= attempt([&] { read_cameras(settings, {}); });
  read |= attempt([&] { read_cameras(one, {1280, 720}); });
  if (!read) throw DataError("refused by every setting");
}

}  // namespace hypotrack::fuzz
