#include "hands_in_view.hpp"

#include <algorithm>
#include <stdexcept>

#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack::landmarks::test {
namespace {

constexpr int kSize = 128;

std::shared_ptr<const Model> make_model(const std::string& yaml) {
  PluginLoader plugins;
  return plugins.make<Model>(ConfigNode::parse(yaml, "scene.yaml"));
}

HandPoints3D points(const Scene::Item& item, const Eigen::VectorXd& state) {
  const Model& model = *item.model;
  return hand_model(model)->in_detector_order(
      posed_landmarks(model, two_hands().part(item, state)));
}

}  // namespace

const Scene& two_hands() {
  static const Scene scene(
      {{"hand", make_model("type: hand\n")}, {"left", make_model("type: mirrored_hand\n")}});
  return scene;
}

Eigen::VectorXd relaxed() {
  Eigen::VectorXd state = two_hands().rest_state();
  for (const Scene::Item& item : two_hands().items()) {
    // Turned, so that palms face the cameras and fingers point up in the pictures.
    state.segment<kPoseSize>(item.offset) << (item.name == "hand" ? 0.12 : 0.0), 0.05, 0.5, 0, 1, 0,
        0;
  }
  return state;
}

Eigen::VectorXd bent(Eigen::VectorXd state, const std::string& finger, double angle) {
  const auto& parameters = two_hands().parameters();
  const auto found = std::ranges::find(parameters, finger + "_flexion_1", &Parameter::name);
  if (found == parameters.end()) throw std::out_of_range(finger);
  state[found - parameters.begin()] += angle;
  return state;
}

Observation observation(const Eigen::VectorXd& start, int frame) {
  Observation out;
  out.frame = frame;
  out.time = frame / 30.0;
  out.scene = &two_hands();
  out.start = start;
  out.rectified = true;
  for (int i = 0; i < 2; ++i) {
    TileView view;
    view.camera = {kSize, kSize, 200, 200, 40, 80, Eigen::Isometry3d::Identity()};
    view.camera.camera_from_world.translation().x() = -0.06 * i;
    view.color = cv::Mat3b(kSize, kSize, cv::Vec3b(0, 0, 0));
    view.color.at<cv::Vec3b>(0, 0)[0] = static_cast<uchar>(i);
    view.valid = cv::Mat1b(kSize, kSize, uchar{255});
    out.views.push_back(view);
  }
  return out;
}

std::vector<HandDetection> SeesState::hands(const cv::Mat& picture) const {
  const TileCamera& camera = seen.views.at(picture.at<cv::Vec3b>(0, 0)[0]).camera;
  std::vector<HandDetection> out;
  for (const Scene::Item& item : two_hands().items()) {
    const bool is_right = item.name == "hand";
    if (!(is_right ? right : left)) continue;
    HandDetection hand;
    const HandPoints3D world = points(item, state_);
    hand.landmarks = in_tile(world, camera);
    hand.relative = camera.camera_from_world.linear() * (world.colwise() - world.rowwise().mean());
    hand.presence = presence;
    hand.right = is_right != exchanged ? 0.9 : 0.1;
    out.push_back(hand);
  }
  return out;
}

Detector SeesState::detector() {
  constexpr double kNear = 40;  // pixels
  return {.detect =
              [this](const cv::Mat& picture) {
                ++detected;
                return hands(picture);
              },
          .refine = [this](const cv::Mat& picture, const HandPoints& guess,
                           bool is_followed) -> std::optional<HandDetection> {
            ++refined;
            if (is_followed) ++followed;
            for (const HandDetection& hand : hands(picture)) {
              const double distance = (hand.landmarks - guess).colwise().norm().mean();
              if (distance >= kNear) continue;
              if (is_followed && distance > farthest_followed) farthest_followed = distance;
              return hand;
            }
            return std::nullopt;
          }};
}

}  // namespace hypotrack::landmarks::test
