#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/params.hpp"
#include "motion/gestures.hpp"
#include "motion/script.hpp"

namespace hypotrack::synthetic {

enum class RandomRotation { facing, any };
inline std::span<const std::string_view> enum_names(RandomRotation) {
  static constexpr std::array<std::string_view, 2> kNames = {"facing", "any"};
  return kNames;
}

struct AbsenceParams {
  int after = 20;
  Eigen::Vector2d frames{1, 60};
  void visit(ParamVisitor& v) {
    v("after", after,
      {.help = "frames in view, after which all models vanish", .min = 1, .max = 1e6});
    v("frames", frames,
      {.help = "least and most frames until they are back", .min = 1, .max = 1e6});
  }
};

/// `random:` a motion that is drawn from a seed.
struct RandomParams {
  int seed = 1;
  int frames = 60;
  ConfigNode gestures;
  Eigen::Vector3d lowest{-0.10, -0.04, 0.40};
  Eigen::Vector3d highest{0.22, 0.15, 0.70};
  RandomRotation rotation = RandomRotation::facing;
  double tilt = 70 * kDegree;
  double speed = 0.3;
  double turn = 120 * kDegree;
  double gesture_time = 0.7;
  double apart = 0.12;
  ConfigNode hold, pose;
  std::optional<AbsenceParams> absence;
  void visit(ParamVisitor& v) {
    v("seed", seed, {.help = "of the motion", .min = 0});
    v("frames", frames, {.help = "frames with the models in view", .min = 1, .max = 1e6});
    v("gestures", gestures, {.help = "names to draw from; all that there are without it"});
    v("lowest_mm", lowest,
      {.help = "corner x y z of the box that the models' origins (wrists) are drawn in",
       .unit = "mm",
       .to_si = kMillimetre});
    v("highest_mm", highest, {.help = "the opposite corner", .unit = "mm", .to_si = kMillimetre});
    v("rotation", rotation,
      {.help = "facing: palm or back to the camera, fingers from upwards to sideways; or any"});
    v("tilt_deg", tilt,
      {.help = "how far a facing hand is turned away at most",
       .min = 0,
       .max = 180,
       .unit = "deg",
       .to_si = kDegree});
    v("speed_mm_per_s", speed,
      {.help = "mean speed of a model from posture to posture, at most",
       .min = 1,
       .max = 1e5,
       .unit = "mm/s",
       .to_si = kMillimetre});
    v("turn_deg_per_s", turn,
      {.help = "mean speed of its rotation, at most",
       .min = 1,
       .max = 1e5,
       .unit = "deg/s",
       .to_si = kDegree});
    v("gesture_s", gesture_time,
      {.help = "time from gesture to gesture, at least", .min = 0.01, .max = 1e3, .unit = "s"});
    v("apart_mm", apart,
      {.help = "distance of the origins of models that are not held, at least",
       .min = 0,
       .max = 1e5,
       .unit = "mm",
       .to_si = kMillimetre});
    v("hold", hold, {.help = "map of models to the model that holds them"});
    v("pose", pose, {.help = "map of held models to their poses relative to the holder"});
    v("absence", absence, {.help = "all models vanish and come back elsewhere"});
  }
};

/// Draws a motion through postures at random places within the box. In every frame all models are
/// in all pictures. With an absence each stretch in view ends after so many frames; the next one
/// begins anywhere, with another gesture. `node` is where `params` were read. Throws ConfigError
/// with file:line:column, also if no such motion is found.
Script draw_motion(const RandomParams& params, const ConfigNode& node, const Gestures& gestures,
                   const Scene& scene, const std::vector<Camera>& cameras, double frame_rate);

}  // namespace hypotrack::synthetic
