#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "faults.hpp"
#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/renderer.hpp"
#include "hypotrack/plugin/params.hpp"
#include "motion/joint_motion.hpp"
#include "motion/random_motion.hpp"
#include "stage/cards.hpp"
#include "stage/forearm.hpp"
#include "stage/person.hpp"

namespace hypotrack::synthetic {

/// One camera, or two side by side with parallel axes; the left one is the world.
struct CameraParams {
  int count = 2;
  int width = 1280;
  int height = 720;
  double focal_px = 700;
  double baseline = 0.12;
  std::vector<double> distortion;
  bool fisheye = false;
  void visit(ParamVisitor& v) {
    v("count", count, {.help = "one camera, or a pair", .min = 1, .max = 2});
    v("width", width, {.help = "of the images", .min = 16, .max = 8192, .unit = "px"});
    v("height", height, {.help = "of the images", .min = 16, .max = 8192, .unit = "px"});
    v("focal_px", focal_px, {.help = "focal length", .min = 1, .max = 1e5, .unit = "px"});
    v("baseline_mm", baseline,
      {.help = "distance of the pair", .min = 1, .max = 1e4, .unit = "mm", .to_si = kMillimetre});
    v("distortion", distortion,
      {.help = "lens distortion of both, as OpenCV orders it: 4, 5 or 8 coefficients"});
    v("fisheye", fisheye, {.help = "the 4 coefficients are those of OpenCV's fisheye model"});
  }
};

enum class BackgroundKind { color, image, procedural };
inline std::span<const std::string_view> enum_names(BackgroundKind) {
  static constexpr std::array<std::string_view, 3> kNames = {"color", "image", "procedural"};
  return kNames;
}

struct BackgroundParams {
  BackgroundKind kind = BackgroundKind::procedural;
  Eigen::Vector3d color{96, 104, 112};
  std::filesystem::path file;
  double distance = 1.5;
  int clutter = 8;
  int dark_regions = 0;
  std::optional<PersonParams> person;
  int seed = 1;
  void visit(ParamVisitor& v) {
    v("kind", kind,
      {.help = "color, an image on a wall, or procedural: a patterned wall with boxes before it"});
    v("color", color, {.help = "red, green, blue of the kind color", .min = 0, .max = 255});
    v("file", file, {.help = "picture of the kind image"});
    v("distance_mm", distance,
      {.help = "of the wall, which faces the first camera",
       .min = 100,
       .max = 1e5,
       .unit = "mm",
       .to_si = kMillimetre});
    v("clutter", clutter, {.help = "boxes of the kind procedural", .min = 0, .max = 200});
    v("dark_regions", dark_regions,
      {.help = "dark flat boards before the wall of the kinds image and procedural",
       .min = 0,
       .max = 40});
    v("person", person, {.help = "somebody who sits behind the hands, before the rest"});
    v("seed", seed, {.help = "of clutter, dark regions and the pattern", .min = 0});
  }
};

struct LightParams {
  double ambient = 0.45;
  double diffuse = 0.6;
  double specular = 0.12;
  double shininess = 25;
  Eigen::Vector3d direction{0.35, 0.6, 1.0};
  int samples = 4;
  void visit(ParamVisitor& v) {
    v("ambient", ambient,
      {.help = "share of a surface's colour without light", .min = 0, .max = 4});
    v("diffuse", diffuse, {.help = "share that a light adds by its angle", .min = 0, .max = 4});
    v("specular", specular, {.help = "strength of the highlight", .min = 0, .max = 4});
    v("shininess", shininess, {.help = "exponent of the highlight", .min = 1, .max = 1000});
    v("direction", direction, {.help = "in which the light travels, world axes"});
    v("samples", samples, {.help = "antialiasing, samples per pixel", .min = 1, .max = 16});
  }
};

struct SensorParams {
  double noise_sigma = 1.0;
  double blur_sigma = 0;
  std::vector<double> gain;
  std::vector<double> offset;
  double exposure = 0;
  double depth_noise = 0;
  double depth_step = 0.1 * kMillimetre;
  int seed = 1;
  void visit(ParamVisitor& v) {
    v("noise_sigma", noise_sigma,
      {.help = "noise of every pixel and channel", .min = 0, .max = 40, .unit = "of 255"});
    v("blur_px", blur_sigma,
      {.help = "sigma of a Gaussian blur", .min = 0, .max = 20, .unit = "px"});
    v("gain", gain, {.help = "factor on a camera's colours, one per camera", .min = 0, .max = 10});
    v("offset", offset,
      {.help = "offset of a camera's colours, one per camera",
       .min = -255,
       .max = 255,
       .unit = "of 255"});
    v("exposure_s", exposure,
      {.help = "exposure time of a picture, about the frame's time; it blurs motion; at most "
               "1/frame_rate",
       .min = 0,
       .max = 100,
       .unit = "s"});
    v("depth_noise_mm", depth_noise,
      {.help = "sigma of the depth noise at 1 m; grows with the square of the distance, as in "
               "triangulation",
       .min = 0,
       .max = 1000,
       .unit = "mm",
       .to_si = kMillimetre});
    v("depth_step_mm", depth_step,
      {.help = "step of depths, as in recordings; 0: none",
       .min = 0,
       .max = 1000,
       .unit = "mm",
       .to_si = kMillimetre});
    v("seed", seed, {.help = "of the noise", .min = 0});
  }
};

struct SyntheticParams {
  std::optional<CalibrationSettings> calibration;
  CameraParams cameras;
  double frame_rate = 30;
  int frames = 0;
  ConfigNode gestures;
  std::filesystem::path gesture_file;
  ConfigNode keyframes;
  JointFileParams joint_file;
  std::optional<RandomParams> random;
  std::vector<FaultParams> faults;
  std::vector<CardParams> cards;
  ConfigNode render_models;
  ForearmParams forearm;
  BackgroundParams background;
  LightParams light;
  SensorParams sensor;
  bool depth = false;
  void visit(ParamVisitor& v) {
    v("cameras", cameras, {.help = "the cameras that take the pictures"});
    v("calibration", calibration, {.help = "cameras from a file, instead of `cameras`"});
    v("frame_rate", frame_rate,
      {.help = "frames per second", .min = 0.01, .max = 1e4, .unit = "Hz"});
    v("frames", frames,
      {.help = "number of frames; 0: up to the last keyframe", .min = 0, .max = 1e7});
    v("gestures", gestures,
      {.help = "named hand postures: maps of joint angles to degrees; * in a name is any text"});
    v("gesture_file", gesture_file, {.help = "YAML file of more gestures, as `gestures` has them"});
    v("keyframes", keyframes,
      {.help =
           "list of {time or frame, gesture, pose, hold, release} that the motion passes through"});
    v("joint_file", joint_file, {.help = "instead of keyframes: a real motion to follow"});
    v("random", random, {.help = "instead of keyframes: a motion that is drawn from a seed"});
    v("faults", faults,
      {.help = "list of {frames: [first, last], kind, model, view}: faults of frames"});
    v("cards", cards, {.help = "list of flat cards that hide the scene behind them"});
    v("render_models", render_models,
      {.help = "map of models of the scene to {type, ...}, the models that pictures show instead"});
    v("forearm", forearm, {.help = "arm below a hand's wrist in the pictures"});
    v("background", background, {.help = "scenery behind the models"});
    v("light", light, {.help = "how the models are lit"});
    v("sensor", sensor, {.help = "noise and blur of the cameras, and their colours"});
    v("depth", depth,
      {.help = "every view also gets the depth of the models and of the background's surfaces (a "
               "background of the kind color has none)"});
  }
};

}  // namespace hypotrack::synthetic
