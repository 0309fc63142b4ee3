#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <opencv2/core.hpp>

#include "hypotrack/plugin/plugin.hpp"
#include "test_models.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

/// The source of a scene in configs/, with files of the shared data.
std::unique_ptr<Source> source_of(const std::string& scene_file, PluginLoader& plugins,
                                  const Scene& scene, const std::vector<std::string>& overrides) {
  const ConfigNode config =
      ConfigNode::load_scene(test::source_dir() / "configs/scenes" / scene_file, overrides);
  return plugins.make<Source>(config.get("source"), &scene);
}

std::string in_shared(const std::string& key, const std::string& path) {
  return "source." + key + "=" + (test::shared_data() / path).string();
}

TEST(RealRecordings, OfTheStbPairProjectTheirLabelsOntoTheHand) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  // Landmarks with the names of the hand's; the shape does not matter here.
  ModelData data = test::make_test_hand();
  std::vector<std::string> names = {"wrist", "thumb_cmc", "thumb_mcp", "thumb_ip", "thumb_tip"};
  for (const char* finger : {"index", "middle", "ring", "little"}) {
    for (const char* joint : {"_mcp", "_pip", "_dip", "_tip"}) {
      names.push_back(std::string(finger) + joint);
    }
  }
  ASSERT_EQ(data.landmarks.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) data.landmarks[i].name = names[i];
  const Scene scene({{"hand", std::make_shared<Model>(data)}});
  PluginLoader plugins;
  const auto source =
      source_of("stb_pair.yaml", plugins, scene,
                {in_shared("left", "stereo/stb/BB_left_%d.png"),
                 in_shared("right", "stereo/stb/BB_right_%d.png"),
                 in_shared("truth_landmarks", "stereo/stb/B1Counting_BB_rows000-499.csv")});
  const auto frame = source->next();
  ASSERT_TRUE(frame);
  ASSERT_EQ(frame->problem, "");
  ASSERT_TRUE(frame->truth);
  ASSERT_EQ(frame->truth->landmarks.cols(), 21);
  EXPECT_TRUE(frame->truth->landmarks.col(0).array().isNaN().all()) << "the palm is no wrist";
  for (std::size_t v = 0; v < 2; ++v) {
    int on_skin = 0;
    for (int i = 1; i < 21; ++i) {
      const Eigen::Vector2d p = project(source->cameras()[v], frame->truth->landmarks.col(i));
      const auto color = frame->views[v].color.at<cv::Vec3b>(static_cast<int>(std::lround(p.y())),
                                                             static_cast<int>(std::lround(p.x())));
      // Skin is redder than green and greener than blue; the curtain is grey, violet and pink.
      on_skin += color[2] > color[1] + 10 && color[1] > color[0];
    }
    // The labels are good to 5-10 mm: a tip or two lies beside its finger.
    EXPECT_GE(on_skin, 16) << "view " << v;
  }
}

TEST(RealRecordings, OfTwoWebcamsAreReadToTheirEnd) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  const Scene scene({{"hand", std::make_shared<Model>(test::make_test_hand())}});
  PluginLoader plugins;
  const auto source = source_of("two_webcams.yaml", plugins, scene,
                                {in_shared("left", "stereo/handpose3d/media/cam0_test.mp4"),
                                 in_shared("right", "stereo/handpose3d/media/cam1_test.mp4"),
                                 "source.start=370", "source.count=100"});
  EXPECT_EQ(source->frame_rate(), 30);
  EXPECT_NEAR(source->cameras()[1].camera_from_world.translation().norm(), 0.5008, 1e-4);
  int frames = 0;
  while (const auto frame = source->next()) {
    EXPECT_EQ(frame->problem, "");
    ++frames;
  }
  EXPECT_EQ(frames, 8);
}

TEST(RealRecordings, OfADepthCameraWithoutColourAreMetres) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  const auto sequences = test::shared_data() / "rgbd/hand_recognition_SR305/datasets/custom";
  const test::TemporaryDirectory folder;
  std::ofstream(folder.path() / "sr305.yaml")
      << "%YAML:1.0\n---\ncameras:\n  - {image_width: 640, image_height: 480, model: none, K: "
         "[476.007, 0, 313.683, 0, 476.007, 242.755, 0, 0, 1]}\n";
  PluginLoader plugins;
  int frames = 0;
  for (const char* sequence : {"20210326-230536", "20210326-231615"}) {
    const std::string yaml =
        "type: image_sequence\nleft_depth: " + (sequences / sequence / "*.png").string() +
        "\ndepth_units_mm: 0.125\ncalibration: {file: sr305.yaml}\n";
    const auto source =
        plugins.make<Source>(ConfigNode::parse(yaml, "scene.yaml", folder.path()), nullptr);
    while (const auto frame = source->next()) {
      ASSERT_EQ(frame->problem, "");
      ASSERT_EQ(frame->views.size(), 1u);
      const cv::Mat& depth = frame->views[0].depth;
      // A person at arm's length from the camera; a unit off would be a factor of 8.
      double nearest = 0, farthest = 0;
      cv::minMaxLoc(depth, &nearest, &farthest, nullptr, nullptr, depth > 0);
      EXPECT_GT(nearest, 0.3);
      EXPECT_LT(farthest, 1.2);
      EXPECT_GT(cv::countNonZero(depth), 50000);
      ++frames;
    }
  }
  EXPECT_EQ(frames, 19);
}

}  // namespace
}  // namespace hypotrack
