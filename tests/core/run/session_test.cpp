#include "hypotrack/api/session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <iterator>
#include <vector>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "scoped_variable.hpp"
#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kSource = R"(source:
  type: synthetic
  frames: 3
  cameras: {width: 320, height: 240, focal_px: 300, baseline_mm: 100}
  keyframes:
    - {frame: 0, pose: {box: {position_mm: [0, 0, 500]}}}
    - {frame: 2, pose: {box: {position_mm: [10, 5, 510]}}}
)";
constexpr const char* kRest = R"(models:
  - {name: box, type: rigid_box, size_mm: [60, 90, 40]}
objective: {type: stereo_color}
optimizer: {type: pso, particles: 16, generations: 8}
tile: {size: 64}
)";
constexpr const char* kStart = "init: {pose: {box: {position_mm: [0, 0, 500]}}}\n";

/// Remembers what a run says, and may end it.
struct Recorder : RunWatcher {
  bool stop() override { return static_cast<int>(states.size()) == most; }
  void begin(std::optional<int> frames) override { total = frames; }
  void frame(const Frame& /*frame*/, const Solution& solution, double error) override {
    states.push_back(solution.state);
    errors.push_back(error);
  }
  void end() override { ++ends; }

  int most = 1000;
  std::optional<int> total;
  std::vector<Eigen::VectorXd> states;
  std::vector<double> errors;
  int ends = 0;
};

class SessionTest : public ::testing::Test {
 protected:
  std::filesystem::path scene(const std::string& text) const {
    const auto file = folder_.path() / "scene.yaml";
    std::ofstream(file) << text;
    return file;
  }
  std::filesystem::path path(const char* name) const { return folder_.path() / name; }

  /// The frames and cameras of kSource.
  std::vector<Frame> frames() {
    PluginLoader plugins;
    const OpenedScene opened =
        open_source(scene(std::string(kRest) + kSource + kStart), {}, plugins);
    cameras_ = opened.source->cameras();
    std::vector<Frame> out;
    while (auto frame = opened.source->next()) out.push_back(*std::move(frame));
    return out;
  }

  test::TemporaryDirectory folder_;
  std::vector<Camera> cameras_;
};

TEST_F(SessionTest, RefusesToLookWithoutAStartThatCanBeUsed) {
  const auto share = test::build_dir() / "share/hypotrack";
  std::filesystem::create_directories(path("configs/starters"));
  for (const char* data : {"hands", "rigs"})
    std::filesystem::create_directory_symlink(share / data, path(data));
  std::ofstream(path("configs/starters/auto.yaml"))
      << "- {type: hand_landmarks, folder: /nowhere}\n";
  const test::ScopedVariable variable("HYPOTRACK_DATA_PATH", folder_.path().string());
  const std::string hand = R"(models: [{name: hand, type: hand}]
source: {type: synthetic, frames: 1, motion: {frames: 1}}
objective: {type: stereo_color}
optimizer: {type: pso, particles: 16, generations: 8}
judge: none
init: {from: auto}
)";
  EXPECT_THAT(message_of<ConfigError>([&] { Session session(scene(hand)); }),
              AllOf(HasSubstr("scene.yaml:6:"), HasSubstr("none of its starters can be used"),
                    HasSubstr("/nowhere")));
}

TEST_F(SessionTest, NamesTheFileOfTheUsualStartsIfThatIsWrong) {
  std::filesystem::create_directories(path("configs/starters"));
  const test::ScopedVariable data("HYPOTRACK_DATA_PATH", folder_.path().string());
  const auto text = std::string(kRest) + kSource + "judge: none\ninit: {from: auto}\n";
  const auto problem_of = [&](const char* starts) {
    std::ofstream(path("configs/starters/auto.yaml")) << starts;
    return message_of<ConfigError>([&] { Session session(scene(text)); });
  };
  const std::string file = path("configs/starters/auto.yaml").string();
  for (const char* no_list : {"a: b\n", "global_search\n", ""})
    EXPECT_THAT(problem_of(no_list),
                AllOf(HasSubstr(file), HasSubstr("expected a list of starters")));
}

TEST_F(SessionTest, TracksFramesOfTheCallerAsARunTracksThoseOfItsSource) {
  const std::vector<Frame> given = frames();
  Recorder run;
  Session with_source(scene(std::string(kRest) + kSource + kStart));
  ASSERT_TRUE(with_source.run({}, run));

  Session session(scene(std::string(kRest) + kStart));
  Tracker tracker = session.tracker(cameras_);
  ASSERT_EQ(given.size(), 3U);
  ASSERT_EQ(run.states.size(), 3U);
  EXPECT_LT(run.errors[2], 0.02) << "known without files, too";
  for (std::size_t i = 0; i < given.size(); ++i) {
    const Solution solution = tracker.track(given[i]);
    EXPECT_EQ(solution.state, run.states[i]) << "frame " << i;
    EXPECT_EQ(solution.landmarks, session.scene().landmarks(solution.state));
    EXPECT_LT((solution.landmarks - tracker.scene().landmarks(given[i].truth->state)).norm(), 0.02);
  }
}

TEST_F(SessionTest, GivesTrackersThatKnowNothingOfEachOther) {
  const std::vector<Frame> given = frames();
  auto session = std::make_unique<Session>(scene(std::string(kRest) + kStart));
  Tracker first = session->tracker(cameras_), second = session->tracker(cameras_);
  session.reset();
  const Solution alone = first.track(given[0]);
  first.track(given[1]);
  EXPECT_EQ(second.track(given[0]).state, alone.state);
}

TEST_F(SessionTest, GivesCamerasWithoutASizeThatOfTheirImages) {
  const std::vector<Frame> given = frames();
  std::vector<Camera> unsized = cameras_;
  for (Camera& camera : unsized) camera.width = camera.height = 0;
  Session session(scene(std::string(kRest) + kStart));
  Tracker tracker = session.tracker(unsized);
  EXPECT_EQ(tracker.track(given[0]).state, session.tracker(cameras_).track(given[0]).state);
  EXPECT_EQ(tracker.cameras()[1].width, 320);
}

TEST_F(SessionTest, StartsFromTheTruthOfTheFirstUsableFrame) {
  std::vector<Frame> given = frames();
  Session session(scene(std::string(kRest) + "init: {from: truth}\n"));
  Tracker tracker = session.tracker(cameras_);
  Frame missing;
  missing.index = -1;
  missing.time = -1;
  EXPECT_EQ(tracker.track(missing).status, Status::missing);
  EXPECT_EQ(tracker.track(given[0]).status, Status::tracked);
  Tracker other = session.tracker(cameras_);
  given[0].truth.reset();
  EXPECT_THAT(message_of<ConfigError>([&] { other.track(given[0]); }),
              HasSubstr("init.from is 'truth'"));
}

TEST_F(SessionTest, RefusesFramesThatDoNotFit) {
  const std::vector<Frame> given = frames();
  Session session(scene(std::string(kRest) + kStart));
  Tracker tracker = session.tracker(cameras_);
  tracker.track(given[0]);
  const auto refusal = [&](Frame frame) {
    return message_of<DataError>([&] { tracker.track(frame); });
  };
  EXPECT_THAT(refusal(given[0]), HasSubstr("frame 0 comes after frame 0; expected a larger index"));
  Frame frame = given[1];
  frame.time = given[0].time;
  EXPECT_THAT(refusal(frame), HasSubstr("expected a later time"));
  frame = given[1];
  frame.views.pop_back();
  EXPECT_THAT(refusal(frame), HasSubstr("frame 1 has 1 view; expected 2, one per camera"));
  frame = given[1];
  frame.views[1] = {};
  EXPECT_THAT(refusal(frame), HasSubstr("frame 1: view 1 has no image"));
  frame = given[1];
  frame.views[1].color = frame.views[1].color(cv::Rect(0, 0, 100, 100)).clone();
  EXPECT_THAT(refusal(frame), AllOf(HasSubstr("100"), HasSubstr("320")));
  EXPECT_EQ(tracker.track(given[1]).status, Status::tracked) << "a refused frame changes nothing";
}

TEST_F(SessionTest, RefusesCamerasThatCannotBe) {
  frames();
  Session session(scene(std::string(kRest) + kStart));
  EXPECT_THAT(message_of<DataError>([&] { session.tracker({}); }),
              HasSubstr("at least one camera"));
  cameras_[1].fx = -1;
  EXPECT_THAT(message_of<DataError>([&] { session.tracker(cameras_); }),
              HasSubstr("camera 1 of the tracker"));
}

TEST_F(SessionTest, RefusesToGoOnAfterAStartThatFailed) {
  std::vector<Frame> given = frames();
  for (Camera& camera : cameras_) camera.width = camera.height = 0;
  Session session(scene(std::string(kRest) + kStart +
                        "uncertainty: {enabled: true}\nbudget: {evaluations: 20}\n"));
  Tracker tracker = session.tracker(cameras_);
  EXPECT_THAT(message_of<ConfigError>([&] { tracker.track(given[0]); }), HasSubstr("uncertainty"));
  EXPECT_THAT(message_of<DataError>([&] { tracker.track(given[0]); }),
              HasSubstr("could not start"));
}

TEST_F(SessionTest, RefusesAShapeThatNeedsTheSource) {
  frames();
  Session session(scene(std::string(kRest) + kStart + "shape: {estimate_s: 1}\n"));
  EXPECT_THAT(message_of<ConfigError>([&] { session.tracker(cameras_); }),
              HasSubstr("hypotrack fit-shape"));
}

TEST_F(SessionTest, ATrackerThatIsStoppedInAFrameTracksTheNext) {
  const std::vector<Frame> given = frames();
  Session session(scene(std::string(kRest) + kStart));
  Tracker tracker = session.tracker(cameras_);
  std::atomic<int> asked = 0;
  EXPECT_THROW(tracker.track(given[0], [&] { return ++asked > 40; }), Stopped);
  EXPECT_THAT(message_of<DataError>([&] { tracker.track(given[0]); }),
              HasSubstr("frame 0 comes after frame 0"));
  EXPECT_EQ(tracker.track(given[1]).status, Status::tracked);
}

TEST_F(SessionTest, WithoutASourceTracksButDoesNotRun) {
  Session session(scene(std::string(kRest) + kStart));
  RunWatcher nobody;
  EXPECT_THAT(message_of<ConfigError>([&] { session.run({}, nobody); }),
              HasSubstr("source: required key is missing"));
}

TEST_F(SessionTest, GivesTheFramesOfItsSource) {
  const std::vector<Frame> given = frames();
  std::unique_ptr<Source> source;
  source = Session(scene(std::string(kRest) + kSource + kStart)).source();
  EXPECT_EQ(source->frame_count(), 3);
  EXPECT_EQ(source->cameras().size(), cameras_.size());
  for (const Frame& frame : given) EXPECT_EQ(source->next()->truth->state, frame.truth->state);
  EXPECT_FALSE(source->next());
  EXPECT_THAT(
      message_of<ConfigError>([&] { Session(scene(std::string(kRest) + kStart)).source(); }),
      HasSubstr("source: required key is missing"));
}

TEST_F(SessionTest, RefusesAWrongSceneWhenItIsOpened) {
  EXPECT_THAT(message_of<ConfigError>([&] { Session(scene(std::string(kRest) + "sead: 1\n")); }),
              HasSubstr("seed"));
}

TEST_F(SessionTest, AppliesTheChangesOfItsOptions) {
  Session session(scene(std::string(kRest) + kStart),
                  {.set = {"models.0.name=crate"}, .plugin_path = {}});
  EXPECT_EQ(session.scene().items().front().name, "crate");
}

TEST_F(SessionTest, RunsTellTheWatcherOfEveryFrameAndWriteResults) {
  Session session(scene(std::string(kRest) + kSource + kStart));
  Recorder recorder;
  EXPECT_TRUE(session.run({.out = path("result"), .frames = {}}, recorder));
  EXPECT_EQ(recorder.total, 3);
  EXPECT_EQ(recorder.states.size(), 3U);
  EXPECT_LT(recorder.errors[1], 0.02);
  EXPECT_EQ(recorder.ends, 1);
  EXPECT_TRUE(std::filesystem::exists(path("result") / "track.csv"));
}

TEST_F(SessionTest, RunsEndBeforeTheFirstFrameAndWriteNothing) {
  Session session(scene(std::string(kRest) + kSource + kStart));
  Recorder recorder;
  recorder.most = 0;
  EXPECT_FALSE(session.run({.out = path("result"), .frames = {}}, recorder));
  EXPECT_TRUE(recorder.states.empty());
  EXPECT_FALSE(std::filesystem::exists(path("result")));
}

TEST_F(SessionTest, RunsEndInTheMiddleOfAFrameAndKeepThoseBefore) {
  Session session(scene(std::string(kRest) + kSource + kStart));
  Recorder recorder;
  std::atomic<int> asked = 0;
  const auto in_third = [&] { return recorder.states.size() == 2 && ++asked > 40; };
  EXPECT_FALSE(session.run({.out = path("result"), .frames = {}, .stop_now = in_third}, recorder));
  EXPECT_EQ(recorder.states.size(), 2U);
  EXPECT_EQ(recorder.ends, 1);
  std::ifstream table(path("result") / "track.csv");
  const auto lines = std::count(std::istreambuf_iterator<char>(table), {}, '\n');
  EXPECT_EQ(lines, 3) << "the header and two frames";
}

TEST_F(SessionTest, RunsEndWhereTheWatcherWantsIt) {
  Session session(scene(std::string(kRest) + kSource + kStart));
  Recorder recorder;
  recorder.most = 2;
  EXPECT_FALSE(session.run({.out = path("result"), .frames = {}}, recorder));
  EXPECT_EQ(recorder.states.size(), 2U);
  EXPECT_EQ(recorder.ends, 1);
  EXPECT_TRUE(std::filesystem::exists(path("result") / "track.csv"));
  Recorder once;
  EXPECT_TRUE(session.run({.out = {}, .frames = 1}, once)) << "a session runs more than once";
  EXPECT_EQ(once.states.size(), 1U);
}

}  // namespace
}  // namespace hypotrack
