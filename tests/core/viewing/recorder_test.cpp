#include "viewing/recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hypotrack/api/config.hpp"
#include "hypotrack/api/media.hpp"
#include "hypotrack/api/pose.hpp"
#include "live_world.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;

class NoFrames final : public Source {
 public:
  explicit NoFrames(std::vector<Camera> cameras) : cameras_(std::move(cameras)) {}

 private:
  const std::vector<Camera>& do_cameras() const override { return cameras_; }
  double do_frame_rate() const override { return 30; }
  std::optional<Frame> do_next() override { return std::nullopt; }

  std::vector<Camera> cameras_;
};

class RecorderTest : public testing::Test {
 protected:
  void SetUp() override {
    opened_.scene =
        std::make_unique<Scene>(std::vector<std::pair<std::string, std::shared_ptr<const Model>>>{
            {"hand", world_.scene.items()[0].model}});
    opened_.source = std::make_unique<NoFrames>(world_.cameras);
    opened_.resolved = "models: [{name: hand}]\nsource: {type: other}\ninit: {from: truth}\n";
    recorder_.open(opened_);
    recorder_.set_folder(results_);
  }
  bool add(int index, Status status = Status::tracked) {
    return recorder_.add(world_.frame(index), world_.solution(index, status, 1));
  }
  ConfigNode scene(const std::string& recording) const {
    return ConfigNode::load(folder_.path() / recording / "scene.yaml");
  }

  LiveWorld world_;
  TemporaryDirectory folder_;
  const OpenFolder results_{folder_.path()};
  OpenedScene opened_;
  std::string said_;
  Recorder recorder_{[this](const std::string& text) { said_ = text; }};
};

TEST_F(RecorderTest, ARecordingHoldsTheFramesUntilItIsStopped) {
  EXPECT_FALSE(recorder_.recorded());
  for (int i = 7; i < 10; ++i) ASSERT_TRUE(add(i)) << said_;
  EXPECT_EQ(recorder_.recorded(), 3);
  recorder_.stop();
  EXPECT_FALSE(recorder_.recorded());
  EXPECT_THAT(said_, HasSubstr("3 frames are recorded in"));
  const ConfigNode source = scene("recording_000007").get("source");
  EXPECT_EQ(source.get("start").scalar(), "7");
  EXPECT_EQ(source.get("count").scalar(), "3");
  EXPECT_EQ(read_image(folder_.path() / "recording_000007" / "right_000009.png").size(),
            cv::Size(320, 240));
}

TEST_F(RecorderTest, ItStartsWhereTheModelsWereInItsFirstFrame) {
  ASSERT_TRUE(add(7));
  ASSERT_TRUE(add(8, Status::lost));
  recorder_.stop();
  const ConfigNode pose = scene("recording_000007").get("init").get("pose");
  const Eigen::VectorXd start = read_pose(pose, world_.scene, world_.scene.rest_state());
  EXPECT_LT((start - world_.solution(7, Status::tracked, 1).state).cwiseAbs().maxCoeff(), 1e-6);
}

TEST_F(RecorderTest, ItStartsAsTheRunDidWhereAModelWasLost) {
  ASSERT_TRUE(add(7, Status::lost));
  recorder_.stop();
  EXPECT_EQ(scene("recording_000007").get("init").get("from").scalar(), "truth");
}

TEST_F(RecorderTest, EarlierRecordingsAreKept) {
  for (const char* name : {"recording_000007", "recording_000007_2", "recording_000007_3"}) {
    ASSERT_TRUE(add(7)) << said_;
    recorder_.stop();
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / name / "scene.yaml")) << name;
  }
}

TEST_F(RecorderTest, MissingFramesDoNotStartARecording) {
  const Frame missing{.index = 6, .time = 0.2, .views = {}, .truth = {}, .problem = "damaged"};
  EXPECT_TRUE(recorder_.add(missing, world_.solution(6, Status::missing, 0)));
  EXPECT_FALSE(recorder_.recorded());
  ASSERT_TRUE(add(7));
  EXPECT_TRUE(recorder_.add(missing, world_.solution(8, Status::missing, 0)));
  EXPECT_EQ(recorder_.recorded(), 2);
}

TEST_F(RecorderTest, AFolderThatCannotBeMadeEndsTheRecordingOnly) {
  const OpenFolder proc("/proc");
  Recorder nowhere([this](const std::string& text) { said_ = text; });
  nowhere.open(opened_);
  nowhere.set_folder(proc);
  EXPECT_FALSE(nowhere.add(world_.frame(7), world_.solution(7, Status::tracked, 1)));
  EXPECT_FALSE(nowhere.recorded());
  EXPECT_THAT(said_, HasSubstr("nothing is recorded: /proc/recording_000007"));
}

}  // namespace
}  // namespace hypotrack::test
