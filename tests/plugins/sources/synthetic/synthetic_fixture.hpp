#pragma once

#include <cstring>
#include <memory>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "test_models.hpp"

namespace hypotrack::test {

inline Scene hand_and_box() {
  std::vector<std::pair<std::string, std::shared_ptr<const Model>>> models;
  models.emplace_back("hand", std::make_shared<Model>(make_test_hand()));
  models.emplace_back("box", std::make_shared<Model>(make_test_box()));
  return Scene(std::move(models));
}

inline constexpr const char* kCameras =
    "cameras: {width: 320, height: 200, focal_px: 175, baseline_mm: 120}\n";
inline constexpr const char* kQuiet = "sensor: {noise_sigma: 0}\n";
inline constexpr const char* kPlain = "background: {kind: color, color: [10, 20, 30]}\n";
inline constexpr const char* kMotion = R"(
gestures:
  fist: {"*_flexion_*": 50, thumb_abduction: 10}
keyframes:
  - time: 0
    gesture: rest
    pose:
      hand: {position_mm: [-20, 60, 420], rotation_deg: [0, 170, 0]}
      box: {position_mm: [100, 0, 500]}
  - {frame: 5, gesture: {hand: fist}}
  - {frame: 10, pose: {hand: {position_mm: [30, 50, 450], angles_deg: {index_flexion_1: 15}}}}
)";

/// The source on a scene of the test hand and the test box.
struct Loaded {
  explicit Loaded(const std::string& yaml)
      : scene(hand_and_box()),
        source(plugins.make<Source>(ConfigNode::parse("type: synthetic\n" + yaml, "scene.yaml"),
                                    &scene)) {}
  std::vector<Frame> frames() {
    std::vector<Frame> all;
    while (std::optional<Frame> frame = source->next()) all.push_back(std::move(*frame));
    return all;
  }
  PluginLoader plugins;
  Scene scene;
  std::unique_ptr<Source> source;
};

inline Loaded load(const std::string& yaml) { return Loaded(yaml); }

/// Bit for bit.
inline bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() &&
         std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

/// Place of a parameter in the state.
inline int parameter(const Scene& scene, const std::string& name) {
  for (int i = 0; i < scene.dimension(); ++i) {
    if (scene.parameters()[static_cast<std::size_t>(i)].name == name) return i;
  }
  throw std::out_of_range(name);
}

/// The message that loading ends in.
inline std::string message_of(const std::string& yaml) {
  try {
    load(kCameras + yaml);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace hypotrack::test
