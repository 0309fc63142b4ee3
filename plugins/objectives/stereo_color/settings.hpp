#pragma once

#include <cmath>
#include <memory>

#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack {
struct Observation;
namespace cuda {
class DeviceObjective;
struct DeviceObservation;
}  // namespace cuda
}  // namespace hypotrack

namespace hypotrack::stereo_color {

enum class ColorSpace { rgb, lab, hsv, gray };
enum class Distinctiveness { principal_curvatures, none };
enum class Aggregation { sum, mean_seen, mean_rendered, sum_per_sqrt };
enum class Direction { left_to_right, right_to_left, both };
enum class Falloff { exponential, gaussian };
enum class Lookup { nearest, bilinear };

/// The values of Params, for code that must not see Eigen.
struct Settings {
  double beta = 100;
  double beta_by_difference = 0;
  double beta_min = 40;
  double beta_max = 120;
  Falloff falloff = Falloff::exponential;
  double coverage_penalty = 0;
  double gray_weight = 1;
  double w_t = 0.1;
  double r = 3e-3;  ///< m
  ColorSpace color_space = ColorSpace::rgb;
  Distinctiveness distinctiveness = Distinctiveness::principal_curvatures;
  Aggregation aggregation = Aggregation::sum;
  Direction direction = Direction::left_to_right;
  Lookup lookup = Lookup::nearest;
  bool use_mask = true;
};

/// Makes the objective on the GPU; null in a build without CUDA. Does not touch the device before
/// it prepares a frame.
std::unique_ptr<cuda::DeviceObjective> make_device_objective(const Settings& settings);

/// Returns the capabilities for `plugins info`; the GPU's only in a build with CUDA.
const char* capabilities();

/// Returns the beta of a frame. It is settings.beta unless beta_by_difference is set and the frame
/// knows the difference of its views. Then it is beta_by_difference / color_difference,
/// quantize_log() and clamped to beta_min .. beta_max.
double beta_of(const Settings& settings, const Observation& observation);

/// Returns the score of one direction. `sum` is over the similarities of pixels seen in both views,
/// `seen` is their number, `rendered` is the number of pixels rendered. Returns 0 without any
/// pixel.
HYPOTRACK_PIXEL double aggregate(Aggregation aggregation, double sum, double seen,
                                 double rendered) {
  double n = 1.0;
  if (aggregation == Aggregation::mean_seen) n = seen;
  if (aggregation == Aggregation::mean_rendered) n = rendered;
  if (aggregation == Aggregation::sum_per_sqrt) n = std::sqrt(rendered);
  return n > 0.0 ? sum / n : 0.0;
}

/// Throws DataError unless there are two views with colour, in tiles of 2x2 pixels or more, and
/// images of their tile's size and type.
void check(const Observation& observation);
/// Checks a frame on the device, whose images always have the right size and type. Throws DataError
/// as above.
void check(const cuda::DeviceObservation& observation);

}  // namespace hypotrack::stereo_color
