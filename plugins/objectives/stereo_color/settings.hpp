#pragma once

#include <memory>

namespace hypotrack {
struct Observation;
namespace cuda {
class DeviceObjective;
}
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

}  // namespace hypotrack::stereo_color
