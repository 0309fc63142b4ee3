#pragma once

#include <memory>

namespace hypotrack {
struct Observation;
namespace cuda {
class DeviceObjective;
}
}  // namespace hypotrack

namespace hypotrack::stereo_patch {

enum class Measure { zncc, census };

/// The values of Params, for code that must not see Eigen.
struct Settings {
  Measure measure = Measure::zncc;
  int radius = 3;  ///< pixels of the tile
  double sharpness = 5;
  double variance_floor = 2e-5;
  double range = 100e-3;          ///< m
  double step = 0.5;              ///< pixels of the tile
  double r = 3e-3;                ///< m
  double full_at_difference = 0;  ///< of colours in 0..1; 0: full weight always
  bool use_mask = true;
};

/// Makes the objective on the GPU; null in a build without CUDA. Does not touch the device before
/// it prepares a frame.
std::unique_ptr<cuda::DeviceObjective> make_device_objective(const Settings& settings);

/// Returns the capabilities for `plugins info`; the GPU's only in a build with CUDA.
const char* capabilities();

/// Planes of the sweep: inverse depths first + k step of the reference view, 0 <= k < count. In a
/// rectified pair they are equidistant in disparity.
struct Planes {
  float first = 0;  ///< 1/m
  float step = 0;   ///< 1/m
  int count = 0;    ///< 2 or more
};

/// Largest number of planes, whatever their distance.
inline constexpr int kMostPlanes = 256;
/// Largest number of values in a volume: large tiles get fewer planes.
inline constexpr int kMostNumbers = 1 << 26;

/// Returns planes around the scene as posed when the tiles were cut. They reach settings.range in
/// front of and behind it, settings.step pixels of the second view apart, or farther where views
/// are far apart. The distance is measured where pixels move fastest, among the tile's middle and
/// corners.
Planes planes_around(const Observation& observation, const Settings& settings);

/// Returns the weight of a pixel in a frame, in 0..1. It is 1 unless full_at_difference is set and
/// the frame knows the difference of its views. Then it is (color_difference /
/// full_at_difference)^2, quantize_log() and at most 1. The square is used because colours count by
/// the inverse of their noise's variance.
double share_of(const Settings& settings, const Observation& observation);

}  // namespace hypotrack::stereo_patch
