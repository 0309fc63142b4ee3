#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "hypotrack/api/session.hpp"
#include "imported_motion.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

constexpr const char* kScene = R"(models:
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
output:
  overlay: false
  worst_frames: 0
  also: [{type: jsonl}, {type: tum}, {type: bvh}, {type: gltf}]
)";

/// Ends a run after two frames, if it is told to.
struct Watcher final : RunWatcher {
  explicit Watcher(bool interrupts) : interrupts_(interrupts) {}
  bool stop() override { return interrupts_ && frames_ == 2; }
  void say(const std::string& /*text*/) override {}
  void frame(const Frame& /*frame*/, const Solution& /*solution*/, double /*error*/) override {
    ++frames_;
  }

 private:
  bool interrupts_;
  int frames_ = 0;
};

class WholeRunTest : public ::testing::Test {
 protected:
  void run(bool interrupts) {
    const auto scene = folder_.path() / "scene.yaml";
    std::ofstream(scene) << kScene;
    Watcher watcher(interrupts);
    Session(scene).run({.out = out(), .frames = {}}, watcher);
  }
  std::filesystem::path out() const { return folder_.path() / "out"; }
  std::vector<std::string> lines(const char* name) const {
    std::ifstream file(out() / name);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
  }

  /// Expects that all files have so many frames, and the same last position of the box.
  void expect_frames(std::size_t count) const {
    const auto objects = lines("track.jsonl");
    ASSERT_THAT(objects, ::testing::SizeIs(count));
    const nlohmann::json parameters =
        nlohmann::json::parse(objects.back())["models"]["box"]["parameters"];
    Eigen::Vector3d position;
    for (int axis = 0; axis < 3; ++axis)
      position[axis] = parameters[std::string("position_") + "xyz"[axis]];
    EXPECT_GT(position.z(), 0.3);
    EXPECT_THAT(lines("box.tum"), ::testing::SizeIs(1 + count));
    const Eigen::Vector3d turned(position.x(), -position.y(), -position.z());
    const test::ImportedMotion bvh(out() / "box.bvh"), glb(out() / "track.glb");
    const double last = static_cast<double>(count) - 1;
    const auto joints = bvh.nodes_at(last),
               nodes = glb.nodes_at(last / 30 * glb.ticks_per_second());
    EXPECT_LT((nodes.at("box").translation() - turned).norm(), 1e-4);
    EXPECT_THAT(joints, ::testing::Contains(::testing::Truly([&](const auto& joint) {
                  return (joint.second.translation() - turned).norm() < 1e-4;
                })));
  }

 private:
  const test::TemporaryDirectory folder_;
};

TEST_F(WholeRunTest, FilesAgree) {
  run(false);
  expect_frames(4);
}

TEST_F(WholeRunTest, FilesOfAnInterruptedRunHaveTheFramesSoFar) {
  run(true);
  expect_frames(2);
}

}  // namespace
}  // namespace hypotrack
