#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "expect_error.hpp"
#include "hypotrack/api/media.hpp"
#include "hypotrack/api/session.hpp"
#include "output_run.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kParticlesScene = R"(models:
  - {name: box, type: rigid_box, size_mm: [60, 90, 40]}
source:
  type: synthetic
  frames: 4
  cameras: {width: 160, height: 120, focal_px: 150, baseline_mm: 100}
  keyframes:
    - {frame: 0, pose: {box: {position_mm: [0, 0, 400]}}}
    - {frame: 3, pose: {box: {position_mm: [10, 5, 410]}}}
objective: {type: stereo_color}
optimizer: {type: pso, particles: 16, generations: 8}
tile: {size: 64}
init: {from: truth}
output: {overlay: false, worst_frames: 0}
)";

class ParticlesTest : public ::testing::Test {
 protected:
  /// Runs a scene with an output and returns the names of its pictures.
  std::vector<std::string> pictures(const std::string& output) const {
    const auto scene = folder_.path() / "scene.yaml";
    std::ofstream(scene) << kParticlesScene;
    RunWatcher watcher;
    Session(scene, {.set = {"output.also=" + output}, .plugin_path = {}})
        .run({.out = out(), .frames = {}}, watcher);
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(out()))
      if (entry.path().filename().string().starts_with("particles_"))
        names.push_back(entry.path().filename());
    std::ranges::sort(names);
    return names;
  }
  cv::Mat picture(const std::string& name) const { return read_image((out() / name).string()); }
  std::filesystem::path out() const { return folder_.path() / "out"; }

 private:
  const test::TemporaryDirectory folder_;
};

TEST_F(ParticlesTest, FramesThatAreAskedForAreDrawn) {
  EXPECT_THAT(pictures("{type: particles, frames: [1, 3]}"),
              ElementsAre("particles_000001.png", "particles_000003.png"));
  const cv::Mat first = picture("particles_000001.png"), last = picture("particles_000003.png");
  ASSERT_FALSE(first.empty());
  EXPECT_EQ(first.size(), last.size());
  EXPECT_GT(cv::norm(first, last, cv::NORM_INF), 0);
}

TEST_F(ParticlesTest, EveryNthFrameIsDrawnFromTheFirstOn) {
  EXPECT_THAT(pictures("{type: particles, every: 3, format: jpg}"),
              ElementsAre("particles_000000.jpg", "particles_000003.jpg"));
  EXPECT_FALSE(picture("particles_000003.jpg").empty());
}

TEST_F(ParticlesTest, FramesAreChosenInOneWay) {
  const Scene scene{{{"box", std::make_shared<Model>(test::make_test_box())}}};
  const test::OutputRun run(scene);
  const auto refused = [&](const std::string& yaml) {
    return message_of<ConfigError>([&] { run.open(yaml); });
  };
  EXPECT_THAT(refused("{type: particles, every: 3, frames: [1]}"),
              HasSubstr("every and frames; expected one of"));
  EXPECT_THAT(refused("{type: particles, frames: [1.5]}"), HasSubstr("frames has 1.5"));
  EXPECT_THAT(refused("type: particles"), HasSubstr("no frames to draw"));
}

}  // namespace
}  // namespace hypotrack
