#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "hypotrack/plugin/output.hpp"
#include "run/run_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

constexpr int kParticles = 16, kGenerations = 8;

constexpr const char* kScene = R"(models:
  - {name: box, type: rigid_box, size_mm: [60, 90, 40]}
source:
  type: synthetic
  frames: 4
  cameras: {width: 160, height: 120, focal_px: 150, baseline_mm: 100}
  keyframes:
    - {frame: 0, pose: {box: {position_mm: [0, 0, 400]}}}
    - {frame: 3, pose: {box: {position_mm: [10, 5, 410]}}}
objective: {type: stereo_color, direction: both}
optimizer: {type: pso, particles: 16, generations: 8}
recovery: {enabled: false}
search: {second_search: 0}
tile: {size: 64}
init: {from: truth}
output: {overlay: false, worst_frames: 0}
)";

/// Takes the searches of some frames.
class Observer final : public Output {
 public:
  struct Seen {
    Solution solution;
    SearchRecord record;
  };

  Observer(std::vector<int> wanted, std::map<int, Seen>& seen)
      : wanted_(std::move(wanted)), seen_(seen) {}

 private:
  std::vector<std::string> do_file_names() const override { return {}; }
  void do_begin(OutputContext& /*run*/) override {}
  bool do_wants_search(const Frame& frame) const override {
    return std::ranges::find(wanted_, frame.index) != wanted_.end();
  }
  void do_search(const Frame& frame, const Solution& solution,
                 const SearchRecord& record) override {
    seen_[frame.index] = {solution, record};
  }
  void do_frame(const Frame& /*frame*/, const Solution& /*solution*/) override {}

  std::vector<int> wanted_;
  std::map<int, Seen>& seen_;
};

class SearchRecordTest : public ::testing::Test {
 protected:
  /// Tracks the scene and returns the searches of the frames that are wanted.
  std::map<int, Observer::Seen> run(const std::vector<int>& wanted, const std::string& out) {
    const auto scene = folder_.path() / "scene.yaml";
    std::ofstream(scene) << kScene;
    std::map<int, Observer::Seen> seen;
    RunAdditions additions;
    additions.outputs.push_back({"observer", std::make_unique<Observer>(wanted, seen)});
    PluginLoader plugins;
    RunWatcher watcher;
    run_scene(scene, {}, plugins, {.out = folder_.path() / out, .frames = {}}, watcher,
              std::move(additions));
    return seen;
  }
  std::string text(const std::string& name) const {
    std::ifstream file(folder_.path() / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  const test::TemporaryDirectory folder_;
};

TEST_F(SearchRecordTest, GenerationsOfASwarmAreBatchesWithTheirCosts) {
  const auto seen = run({1, 3}, "out");
  ASSERT_THAT(seen, SizeIs(2));
  for (const auto& [frame, found] : seen) {
    ASSERT_THAT(found.record.searches, SizeIs(1));
    const RecordedSearch& search = found.record.searches.front();
    EXPECT_FALSE(search.on_device);
    ASSERT_THAT(search.batches, SizeIs(kGenerations));
    double lowest = 1;
    for (const HypothesisBatch& batch : search.batches) {
      EXPECT_EQ(batch.states.rows(), 7);
      EXPECT_EQ(batch.states.cols(), kParticles);
      EXPECT_EQ(batch.costs.size(), kParticles);
      lowest = std::min(lowest, batch.costs.minCoeff());
    }
    EXPECT_EQ(lowest, search.cost);
    EXPECT_EQ(search.cost, found.solution.cost);
    EXPECT_EQ(search.state, found.record.state);
  }
}

TEST_F(SearchRecordTest, TheAnswerIsDrawnInTheTilesOfBothViews) {
  const SearchRecord record = run({2}, "out").at(2).record;
  ASSERT_THAT(record.depth, SizeIs(2));
  for (const cv::Mat& depth : record.depth) {
    ASSERT_EQ(depth.size(), cv::Size(64, 64));
    EXPECT_NEAR(depth.at<float>(32, 32), 0.39, 0.02);  // the front of the box
    EXPECT_EQ(depth.at<float>(0, 0), 0);
  }
}

TEST_F(SearchRecordTest, MapsOfConsistencyAddUpToTheCost) {
  const auto found = run({2}, "out").at(2);
  std::vector<std::string> names;
  double sum = 0;
  for (const auto& [term, map] : found.record.maps) {
    EXPECT_EQ(term, "stereo_color");
    if (map.view == 0) names.push_back(map.name);
    if (map.name != "consistency") continue;
    for (const float s : cv::Mat1f(map.values)) sum += std::isnan(s) ? 0 : s;
  }
  EXPECT_THAT(names, ElementsAre("distinctiveness", "colour difference", "consistency"));
  EXPECT_NEAR(found.solution.cost / (-0.5 * sum), 1, 1e-3);
}

TEST_F(SearchRecordTest, ARecordedRunFindsWhatAnotherFinds) {
  EXPECT_THAT(run({}, "without"), SizeIs(0));
  EXPECT_THAT(run({0, 1, 2, 3}, "with"), SizeIs(4));
  EXPECT_EQ(text("with/joints.csv"), text("without/joints.csv"));
  EXPECT_GT(text("with/joints.csv").size(), 100U);
}

}  // namespace
}  // namespace hypotrack
