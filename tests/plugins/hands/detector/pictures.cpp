#include "pictures.hpp"

#include <cmath>
#include <stdexcept>

#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {
namespace {

OpenedScene open(const std::string& scene, const std::vector<std::string>& overrides,
                 PluginLoader& plugins) {
  OpenedScene out = open_source(source_dir() / "configs/scenes" / scene, overrides, plugins);
  const std::vector<std::string> names = out.scene->landmark_names();
  for (std::size_t i = 0; i < kHandPointNames.size(); ++i) {
    if (names.at(i) != "hand." + std::string(kHandPointNames[i])) {
      throw std::runtime_error("the hand has the landmark " + names[i]);
    }
  }
  return out;
}

std::string from_shared(const std::string& key, const std::string& file) {
  return "source." + key + "=" + (shared_data() / "stereo" / file).string();
}

/// Fills in the true landmarks from the true state.
void complete(Frame& frame, const Scene& scene) {
  if (frame.truth && frame.truth->landmarks.size() == 0) {
    frame.truth->landmarks = scene.landmarks(frame.truth->state);
  }
}

}  // namespace

HandPictures rendered_hand(int frame) {
  PluginLoader plugins;
  const OpenedScene scene = open("demo.yaml", {}, plugins);
  HandPictures out{scene.source->cameras(), {}};
  for (int i = 0; i <= frame; ++i) out.frame = scene.source->next().value();
  complete(out.frame, *scene.scene);
  return out;
}

HandPictures stb_pair() {
  PluginLoader plugins;
  const OpenedScene scene =
      open("stb_pair.yaml",
           {from_shared("left", "stb/BB_left_%d.png"), from_shared("right", "stb/BB_right_%d.png"),
            from_shared("truth_landmarks", "stb/B1Counting_BB_rows000-499.csv")},
           plugins);
  return {scene.source->cameras(), scene.source->next().value()};
}

std::vector<HandPictures> webcam_frames(int step) {
  PluginLoader plugins;
  const OpenedScene scene = open("two_webcams.yaml",
                                 {from_shared("left", "handpose3d/media/cam0_test.mp4"),
                                  from_shared("right", "handpose3d/media/cam1_test.mp4"),
                                  "source.start=0", "source.count=378"},
                                 plugins);
  std::vector<HandPictures> out;
  for (int i = 0; auto frame = scene.source->next(); ++i) {
    if (i % step == 0) out.push_back({scene.source->cameras(), *frame});
  }
  return out;
}

HandPoints true_points(const HandPictures& pictures, std::size_t view) {
  HandPoints out;
  for (Eigen::Index i = 0; i < out.cols(); ++i) {
    out.col(i) = project(pictures.cameras[view], pictures.frame.truth->landmarks.col(i));
  }
  return out;
}

double mean_distance(const HandPoints& a, const HandPoints& b) {
  double sum = 0;
  int count = 0;
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    const double distance = (a.col(i) - b.col(i)).norm();
    if (std::isnan(distance)) continue;
    sum += distance;
    ++count;
  }
  return sum / count;
}

HandDetection only_hand(HandDetector& detector, const cv::Mat& picture) {
  const std::vector<HandDetection> hands = detector.detect(picture);
  if (hands.size() != 1) {
    ADD_FAILURE() << hands.size() << " hands instead of one";
    HandDetection none;
    none.landmarks.setConstant(NAN);
    none.relative.setConstant(NAN);
    return none;
  }
  return hands.front();
}

}  // namespace hypotrack::test
