#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "faults.hpp"
#include "hypotrack/api/renderer.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "motion/motion.hpp"
#include "motion/script.hpp"
#include "params.hpp"
#include "sensor.hpp"
#include "stage/background.hpp"
#include "stage/cards.hpp"
#include "stage/stage.hpp"

namespace hypotrack::synthetic {
namespace {

DistortionModel model_of(const CameraParams& params, const std::string& where) {
  const std::size_t count = params.distortion.size();
  if (params.fisheye) {
    if (count == 4) return DistortionModel::fisheye;
    throw ConfigError(
        fmt::format("{}: cameras.distortion has {} coefficients, but OpenCV's fisheye "
                    "model has 4",
                    where, count));
  }
  if (count == 0) return DistortionModel::none;
  if (count == 4 || count == 5 || count == 8) return DistortionModel::brown;
  throw ConfigError(
      fmt::format("{}: cameras.distortion has {} coefficients, expected 4, 5 or 8", where, count));
}

std::vector<Camera> make_cameras(const CameraParams& params, const std::string& where) {
  Camera camera;
  camera.width = params.width;
  camera.height = params.height;
  camera.fx = camera.fy = params.focal_px;
  camera.cx = 0.5 * (params.width - 1);
  camera.cy = 0.5 * (params.height - 1);
  camera.distortion_model = model_of(params, where);
  camera.distortion = params.distortion;
  std::vector<Camera> cameras(static_cast<std::size_t>(params.count), camera);
  if (cameras.size() == 2) cameras[1].camera_from_world.translation().x() = -params.baseline;
  for (const Camera& c : cameras) validate(c, where);
  return cameras;
}

std::vector<Camera> load_cameras(const CalibrationSettings& settings, const std::string& where,
                                 std::vector<std::string>& notes) {
  std::vector<Camera> cameras = load_calibration(settings, {}, &notes);
  for (const Camera& c : cameras) {
    if (c.width > 0 && c.height > 0) continue;
    throw ConfigError(
        fmt::format("{}: {} does not say how large the images are; give "
                    "calibration.image_size: [width, height]",
                    where, settings.file.string()));
  }
  return cameras;
}

Script read_motion(const SyntheticParams& params, const Scene& scene,
                   const std::vector<Camera>& cameras, const ConfigNode& config) {
  const bool in_file = !params.joint_file.file.empty();
  const bool in_script = params.keyframes.defined() && !params.keyframes.is_null();
  if (in_script + in_file + params.random.has_value() != 1) {
    throw ConfigError(config.where() +
                      ": give the motion by one of `keyframes`, `joint_file: "
                      "{file: ...}` and `random`");
  }
  if (in_file) return read_joint_file(params.joint_file, scene, params.frame_rate);
  const Gestures gestures(params.gestures, params.gesture_file);
  if (params.random) {
    return draw_motion(*params.random, config.get("random"), gestures, scene, cameras,
                       params.frame_rate);
  }
  return read_script(params.keyframes, gestures, scene, params.frame_rate);
}

RenderStyle style_of(const LightParams& light) {
  RenderStyle style;
  style.ambient = light.ambient;
  style.diffuse = light.diffuse;
  style.specular = light.specular;
  style.shininess = light.shininess;
  style.light_direction = light.direction;
  style.samples = light.samples;
  return style;
}

double checked_exposure(const SyntheticParams& params, const ConfigNode& config) {
  constexpr double kRoundOff = 1e-9;
  const double exposure = params.sensor.exposure;
  if (exposure * params.frame_rate <= 1 + kRoundOff) return exposure;
  throw ConfigError(fmt::format(
      "{}: sensor.exposure_s is {:.6g} s, expected at most the time between two frames, "
      "{:.6g} s",
      config.get("sensor").get("exposure_s").where(), exposure, 1 / params.frame_rate));
}

/// Renders the scene's models, or replacements that move alike, on a scripted motion, with ground
/// truth.
class Synthetic final : public Source {
 public:
  using Params = SyntheticParams;

  Synthetic(const Params& params, PluginContext& context)
      : scene_(context.scene()),
        cameras_(params.calibration
                     ? load_cameras(*params.calibration, context.config().where(), notes_)
                     : make_cameras(params.cameras, context.config().where())),
        frame_rate_(params.frame_rate),
        script_(read_motion(params, scene_, cameras_, context.config())),
        faults_(params.faults, context.config().get("faults"), scene_, cameras_),
        style_(style_of(params.light)),
        sensor_(params.sensor, cameras_.size(), context.config().where()),
        depth_sensor_(params.sensor),
        depth_(params.depth),
        exposure_(checked_exposure(params, context.config())),
        stage_(scene_, params.render_models, params.forearm,
               make_cards(params.cards, context.config().get("cards"), frame_rate_), context),
        backgrounds_(params.background, cameras_, style_, stage_.skin(), context.config().where()),
        renderer_(stage_.scene()) {
    for (const auto& [first, last] : script_.absences) faults_.add_absence(first, last);
    frames_ = params.frames > 0 ? params.frames : frames_of_motion(context.config().where());
  }

 private:
  const std::vector<Camera>& do_cameras() const override { return cameras_; }
  std::vector<std::string> do_notes() const override { return notes_; }
  double do_frame_rate() const override { return frame_rate_; }
  std::optional<int> do_frame_count() const override {
    int count = 0;
    for (int n = 0; n < frames_; n = faults_.next_delivered(n + 1)) ++count;
    return count;
  }

  /// Numbers frames as they arrive; after missing ones the time goes on as it would have.
  std::optional<Frame> do_next() override {
    if (next_ >= frames_) return std::nullopt;
    const int number = next_;
    next_ = faults_.next_delivered(number + 1);
    Frame frame;
    frame.index = delivered_++;
    frame.time = number / frame_rate_;
    frame.truth.emplace();
    frame.truth->state = script_.state(frame.time);
    frame.truth->absent = faults_.absent(number);
    const Eigen::VectorXd state = stage_.state(frame.truth->state, frame.time);
    frame.truth->landmarks = stage_.landmarks(state, frame.truth->absent);
    style_.hidden = stage_.hidden(frame.truth->absent, number);
    const std::vector<Eigen::VectorXd> others = other_states(frame.time, state);
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      RenderedView rendered =
          renderer_.render(state, cameras_[i], style_, backgrounds_.views()[i].color);
      blur(rendered.color, others, i);
      sensor_.apply(rendered.color, number, i);
      View view{.color = std::move(rendered.color), .mask = stage_.mask(rendered.label)};
      if (depth_) {
        view.depth = std::move(rendered.depth);
        backgrounds_.views()[i].depth.copyTo(view.depth, rendered.label == 0);
        depth_sensor_.apply(view.depth, number, i);
      }
      frame.views.push_back(std::move(view));
    }
    faults_.apply(number, frame.views);
    return frame;
  }

  /// Returns the states of the stage at which else a picture is rendered during an exposure about
  /// `time`: evenly spread, the more the farther a landmark moves. `state` is that of `time`.
  std::vector<Eigen::VectorXd> other_states(double time, const Eigen::VectorXd& state) const {
    constexpr double kStep = 1.5;  // pixels from one picture to the next
    constexpr int kMost = 8;       // pictures before `time`, and as many after it
    std::vector<Eigen::VectorXd> states;
    const Motion& motion = script_.motion_at(time);
    const auto state_at = [&](double t) { return stage_.state(motion.state(t), t); };
    const Eigen::VectorXd first = state_at(time - 0.5 * exposure_);
    const Eigen::VectorXd last = state_at(time + 0.5 * exposure_);
    const double moved = std::max(pixels_between(first, state), pixels_between(state, last));
    const int steps = std::min(static_cast<int>(std::ceil(moved / kStep)), kMost);
    for (int i = -steps; i <= steps; ++i)
      if (i != 0) states.push_back(state_at(time + i * exposure_ / (2 * steps + 1)));
    return states;
  }

  /// Returns how far a landmark moves at most in the first camera's picture.
  double pixels_between(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    const Eigen::Matrix3Xd from = stage_.scene().landmarks(a), to = stage_.scene().landmarks(b);
    double most = 0;
    for (Eigen::Index i = 0; i < from.cols(); ++i) {
      const double z = (cameras_[0].camera_from_world * from.col(i)).z();
      const double moved = (to.col(i) - from.col(i)).norm();
      if (z > 0) most = std::max(most, cameras_[0].fx * moved / z);
    }
    return most;
  }

  /// Averages a picture with those of other states.
  void blur(cv::Mat& color, const std::vector<Eigen::VectorXd>& others, std::size_t camera) {
    if (others.empty()) return;
    cv::Mat sum;
    color.convertTo(sum, CV_32F);
    for (const Eigen::VectorXd& state : others) {
      cv::add(sum,
              renderer_.render(state, cameras_[camera], style_, backgrounds_.views()[camera].color)
                  .color,
              sum, {}, CV_32F);
    }
    sum.convertTo(color, CV_8U, 1.0 / static_cast<double>(others.size() + 1));
  }

  int frames_of_motion(const std::string& where) const {
    constexpr double kRoundOff = 1e-6, kMost = 1e7;
    const double frames = std::floor(script_.duration * frame_rate_ + kRoundOff) + 1;
    if (frames <= kMost) return static_cast<int>(frames);
    throw ConfigError(
        fmt::format("{}: the motion lasts {:.6g} s, or {:.6g} frames, expected at most {:.0f}; "
                    "give `frames`, or earlier keyframes",
                    where, script_.duration, frames, kMost));
  }

  const Scene scene_;
  std::vector<std::string> notes_;  ///< on the calibration
  const std::vector<Camera> cameras_;
  const double frame_rate_;
  const Script script_;
  Faults faults_;
  RenderStyle style_;
  const Sensor sensor_;
  const DepthSensor depth_sensor_;
  const bool depth_;
  const double exposure_;
  const Stage stage_;
  Backgrounds backgrounds_;
  Renderer renderer_;
  int frames_ = 0;
  int next_ = 0;       ///< frame of the motion
  int delivered_ = 0;  ///< frames before it that were not missing
};

}  // namespace
}  // namespace hypotrack::synthetic

HYPOTRACK_PLUGIN(hypotrack::synthetic::Synthetic,
                 "renders a scripted motion of the scene's models, with ground truth", "truth mask")
