// A tracker that is given no start looks for the models.

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

struct Found {
  Status status;
  double error;  ///< mean over the landmarks, metres
};

/// Opens real_time.yaml with small pictures, and global_search as its starter.
OpenedScene open_unstarted(PluginLoader& plugins, std::vector<std::string> overrides) {
  overrides.insert(overrides.end(),
                   {"evaluate.backend=cpu", "init={from: global_search}",
                    "source.cameras={width: 640, height: 360, focal_px: 350, baseline_mm: 120}"});
  return open_scene(test::source_dir() / "configs/scenes/real_time.yaml", overrides, plugins);
}

/// Tracks frames of open_unstarted().
std::vector<Found> track_unstarted(int frames, std::vector<std::string> overrides) {
  PluginLoader plugins;
  OpenedScene session = open_unstarted(plugins, std::move(overrides));
  std::optional<SceneTracker> tracker;
  std::vector<Found> out;
  for (int i = 0; i < frames; ++i) {
    const Frame frame = session.source->next().value();
    if (!tracker)
      tracker.emplace(*session.scene, std::move(session.parts), initial_state(session, frame),
                      session.seed);
    const Solution solution = tracker->track(frame);
    const Eigen::Matrix3Xd truth = session.scene->landmarks(frame.truth->state);
    out.push_back({solution.status, (solution.landmarks - truth).colwise().norm().mean()});
  }
  return out;
}

TEST(LookedFor, HandIsFoundInTheFirstFrame) {
  const std::vector<Found> found = track_unstarted(2, {});
  EXPECT_EQ(found[0].status, Status::tracked);
  EXPECT_LT(found[0].error, 0.010);
  EXPECT_LT(found[1].error, 0.005);
}

TEST(LookedFor, HandIsFoundWhenItAppears) {
  const std::vector<Found> found =
      track_unstarted(5, {"source.faults=[{frames: [0, 1], kind: absent}]"});
  EXPECT_NE(found[0].status, Status::tracked);
  EXPECT_NE(found[1].status, Status::tracked);
  EXPECT_EQ(found[4].status, Status::tracked);
  EXPECT_LT(found[4].error, 0.010);
}

TEST(LookedFor, PrintedBoxesAreFoundTheRightWayRound) {
  for (const char* seed : {"1", "3"}) {
    const std::vector<Found> found = track_unstarted(
        1,
        {"models=[{name: box, type: rigid_box, size_mm: [110, 160, 70]}]", "source.keyframes=null",
         std::string("source.random={frames: 1, rotation: any, seed: ") + seed + "}"});
    EXPECT_EQ(found[0].status, Status::tracked);
    EXPECT_LT(found[0].error, 0.002) << "seed " << seed;
  }
}

TEST(LookedFor, ModelsNeedTwoViewsAndARecovery) {
  EXPECT_THROW(track_unstarted(1, {"recovery.enabled=false"}), ConfigError);
  EXPECT_THROW(track_unstarted(1, {"judge=none"}), ConfigError);
}

/// Proposes one pose of a model whenever it is asked.
class AlwaysThere final : public Starter {
 public:
  explicit AlwaysThere(Eigen::VectorXd pose) : pose_(std::move(pose)) {}

 private:
  bool do_looks() const override { return true; }
  bool do_detects(std::size_t /*model*/) const override { return true; }
  void do_find(const StarterContext& /*context*/, std::size_t /*model*/,
               const TakePose& take) override {
    take(pose_);
  }

  Eigen::VectorXd pose_;
};

/// Returns an override that gives the judge one value for all thresholds.
std::string all_thresholds(int value) {
  std::string out = "judge={type: network";
  for (const char* key : {"tracked", "certain", "first", "confirmed", "uncertain"})
    out += ", " + std::string(key) + "_above: " + std::to_string(value);
  return out + "}";
}

/// Tracks a hand from 150 mm beside it with a tracker that believes any pose; returns the last
/// frame's error in metres. A starter knows better.
double last_error_of_a_believer(double check_s) {
  PluginLoader plugins;
  const std::vector<std::string> overrides{
      "evaluate.backend=cpu", "recovery.first_restarts=1", all_thresholds(0),
      "recovery.check_s=" + std::to_string(check_s),
      "source.cameras={width: 640, height: 360, focal_px: 350, baseline_mm: 120}"};
  OpenedScene session =
      open_scene(test::source_dir() / "configs/scenes/real_time.yaml", overrides, plugins);
  std::optional<SceneTracker> tracker;
  double error = 0;
  for (int i = 0; i < 6; ++i) {
    const Frame frame = session.source->next().value();
    if (!tracker) {
      session.parts.starters.clear();
      session.parts.starters.push_back(std::make_unique<AlwaysThere>(frame.truth->state));
      Eigen::VectorXd beside = frame.truth->state;
      beside.x() -= 0.15;
      tracker.emplace(*session.scene, std::move(session.parts), beside, session.seed);
    }
    const Solution solution = tracker->track(frame);
    const Eigen::Matrix3Xd truth = session.scene->landmarks(frame.truth->state);
    error = (solution.landmarks - truth).colwise().norm().mean();
  }
  return error;
}

/// A range of frames.
struct Frames {
  int first, end;
};

/// Detects a model, which it sees in some frames, where it was in the first one.
class SteadyDetector final : public Starter {
 public:
  SteadyDetector(Eigen::VectorXd pose, Frames seen) : pose_(std::move(pose)), seen_(seen) {}

 private:
  bool do_looks() const override { return true; }
  bool do_detects(std::size_t /*model*/) const override { return true; }
  void do_find(const StarterContext& context, std::size_t /*model*/,
               const TakePose& take) override {
    if (context.frame->index >= seen_.first && context.frame->index < seen_.end) take(pose_);
  }

  Eigen::VectorXd pose_;
  Frames seen_;
};

/// Counts how often it may search the pictures, and proposes a wrong pose each time.
class WrongSearch final : public Starter {
 public:
  WrongSearch(Eigen::VectorXd pose, int& searches) : pose_(std::move(pose)), searches_(searches) {}

 private:
  bool do_looks() const override { return true; }
  void do_find(const StarterContext& context, std::size_t /*model*/,
               const TakePose& take) override {
    if (!context.search) return;
    ++searches_;
    take(pose_);
  }

  Eigen::VectorXd pose_;
  int& searches_;
};

struct Doubted {
  std::vector<Status> statuses;
  int searches = 0;
  double error = 0;  ///< of the last frame, metres
};

/// Tracks a hand that a starter detects in some frames. Another starter is wrong by 150 mm.
Doubted track_doubted(int frames, Frames seen, std::vector<std::string> overrides) {
  PluginLoader plugins;
  OpenedScene session = open_unstarted(plugins, std::move(overrides));
  std::optional<SceneTracker> tracker;
  Doubted out;
  for (int i = 0; i < frames; ++i) {
    const Frame frame = session.source->next().value();
    if (!tracker) {
      Eigen::VectorXd beside = frame.truth->state;
      beside.x() -= 0.15;
      session.parts.starters.clear();
      session.parts.starters.push_back(std::make_unique<SteadyDetector>(frame.truth->state, seen));
      session.parts.starters.push_back(std::make_unique<WrongSearch>(beside, out.searches));
      tracker.emplace(*session.scene, std::move(session.parts), initial_state(session, frame),
                      session.seed);
    }
    const Solution solution = tracker->track(frame);
    out.statuses.push_back(solution.status);
    out.error =
        (solution.landmarks - session.scene->landmarks(frame.truth->state)).colwise().norm().mean();
  }
  return out;
}

TEST(LookedFor, WhatAStarterWouldDetectAndDoesNotSeeIsSearchedEverMoreSeldom) {
  const Doubted found =
      track_doubted(17, {100, 100}, {"judge={type: network, confirmed_above: 0}"});
  EXPECT_EQ(found.searches, 2) << "in the first frame and the sixteenth";
  for (const Status status : found.statuses) EXPECT_EQ(status, Status::lost);
}

TEST(LookedFor, WhatAStarterSeesElsewhereOnlyIsFoundThere) {
  const Doubted found = track_doubted(14, {2, 100}, {"recovery.check_s=0.1", all_thresholds(0)});
  EXPECT_LT(found.error, 0.02);
}

TEST(LookedFor, PosesThatAStarterDetectsAreFollowedThoughThePicturesDenyThem) {
  const Doubted found = track_doubted(15, {0, 100}, {all_thresholds(1)});
  for (const Status status : found.statuses) EXPECT_EQ(status, Status::uncertain);
  EXPECT_LT(found.error, 0.01);
}

TEST(LookedFor, DetectedPosesAreLostHalfASecondAfterTheyWereSeenLast) {
  const Doubted found = track_doubted(24, {0, 4}, {all_thresholds(1)});
  EXPECT_EQ(found.statuses[17], Status::uncertain);
  EXPECT_EQ(found.statuses[22], Status::lost);
}

TEST(LookedFor, FramesInWhichAStartDeniesAModelAreNotSearched) {
  PluginLoader plugins;
  OpenedScene session = open_unstarted(plugins, {"source.faults=[{frames: [0, 9], kind: absent}]"});
  std::optional<SceneTracker> tracker;
  for (int i = 0; i < 3; ++i) {
    const Frame frame = session.source->next().value();
    if (!tracker) {
      session.parts.starters.insert(
          session.parts.starters.begin(),
          std::make_unique<SteadyDetector>(frame.truth->state, Frames{100, 100}));
      tracker.emplace(*session.scene, std::move(session.parts), initial_state(session, frame),
                      session.seed);
    }
    const Solution solution = tracker->track(frame);
    EXPECT_EQ(solution.status, Status::lost);
    if (i > 0) {
      EXPECT_EQ(solution.evaluations, 0) << "frame " << i;
    }
  }
}

/// Detects the right one of two hands where it is. Takes it for the left one, too, in searches
/// of whole pictures.
class RightHandOnly final : public Starter {
 public:
  RightHandOnly(const Eigen::VectorXd& truth, bool detects) : truth_(truth), detects_(detects) {}

 private:
  bool do_looks() const override { return true; }
  bool do_detects(std::size_t /*model*/) const override { return detects_; }
  void do_find(const StarterContext& context, std::size_t model, const TakePose& take) override {
    const Scene::Item& right = context.scene.items()[0];
    if (model == 0 || (!detects_ && context.search))
      take(truth_.segment(right.offset, right.model->dimension()));
  }

  const Eigen::VectorXd& truth_;
  bool detects_;
};

TEST(LookedFor, AHandThatIsAnotherModelsIsNotTaken) {
  PluginLoader plugins;
  const std::string real_time = (test::source_dir() / "configs/scenes/real_time.yaml").string();
  const std::vector<std::string> overrides{
      "evaluate.backend=cpu",
      "objective=@" + real_time,
      "optimizer=@" + real_time,
      "budget.evaluations=60",
      "tile.size=128",
      "recovery.check_s=0",
      "judge={type: network, certain_above: 0.05, tracked_above: 0.05, confirmed_above: 0.05, "
      "uncertain_above: 0.02}",
      "source.cameras={width: 640, height: 360, focal_px: 350, baseline_mm: 120}",
      "source.faults=[{frames: [3, 5], kind: absent}, {frames: [6, 99], kind: absent, model: "
      "left}]"};
  OpenedScene session =
      open_scene(test::source_dir() / "configs/scenes/two_hands.yaml", overrides, plugins);
  std::optional<SceneTracker> tracker;
  Eigen::VectorXd truth;
  for (int i = 0; i < 10; ++i) {
    const Frame frame = session.source->next().value();
    truth = frame.truth->state;
    if (!tracker) {
      session.parts.starters.clear();
      session.parts.starters.push_back(std::make_unique<RightHandOnly>(truth, true));
      session.parts.starters.push_back(std::make_unique<RightHandOnly>(truth, false));
      tracker.emplace(*session.scene, std::move(session.parts), truth, session.seed);
    }
    const Solution solution = tracker->track(frame);
    if (i < 6) continue;
    EXPECT_EQ(solution.models[0], Status::tracked) << "frame " << i;
    EXPECT_NE(solution.models[1], Status::tracked) << "frame " << i;
    EXPECT_NE(solution.models[1], Status::uncertain) << "frame " << i;
  }
}

/// Tracks a hand that has become a fist, from the pose of the first frame of the recording, when it
/// was open. `prepare` changes the tracker's parts.
template <class Prepare>
std::pair<std::vector<Found>, std::vector<std::string>> track_stale(int frames, Prepare prepare) {
  constexpr int kFist = 46;
  PluginLoader plugins;
  const std::vector<std::string> overrides{
      "evaluate.backend=cpu",
      "source.cameras={width: 640, height: 360, focal_px: 350, baseline_mm: 120}"};
  OpenedScene session =
      open_scene(test::source_dir() / "configs/scenes/real_time.yaml", overrides, plugins);
  const Eigen::VectorXd stale = session.source->next().value().truth->state;
  for (int i = 1; i < kFist; ++i) session.source->next();
  std::optional<SceneTracker> tracker;
  std::vector<Found> out;
  for (int i = 0; i < frames; ++i) {
    const Frame frame = session.source->next().value();
    const Eigen::Matrix3Xd truth = session.scene->landmarks(frame.truth->state);
    if (!tracker) {
      EXPECT_GT((session.scene->landmarks(stale) - truth).colwise().norm().mean(), 0.04);
      prepare(session.parts, frame.truth->state);
      tracker.emplace(*session.scene, std::move(session.parts), stale, session.seed);
    }
    const Solution solution = tracker->track(frame);
    out.push_back({solution.status, (solution.landmarks - truth).colwise().norm().mean()});
  }
  return {out, tracker->take_start_notes()};
}

TEST(GivenStart, OfAnotherMomentIsContradictedByThePictures) {
  const auto [found, notes] = track_stale(2, [](auto&...) {});
  for (const Found& frame : found) {
    EXPECT_EQ(frame.status, Status::tracked);
    EXPECT_LT(frame.error, 0.010);
  }
  ASSERT_EQ(notes.size(), 1);
  EXPECT_NE(notes[0].find("frame 46: the start (init) is not where 'hand' is"), std::string::npos)
      << notes[0];
}

TEST(GivenStart, OfAnotherMomentIsContradictedByADetector) {
  const auto [found, notes] = track_stale(2, [](TrackerParts& parts, const Eigen::VectorXd& truth) {
    parts.starters.clear();
    parts.starters.push_back(std::make_unique<AlwaysThere>(truth));
  });
  for (const Found& frame : found) {
    EXPECT_EQ(frame.status, Status::tracked);
    EXPECT_LT(frame.error, 0.010);
  }
  ASSERT_EQ(notes.size(), 1);
  EXPECT_NE(notes[0].find("a detector sees it"), std::string::npos) << notes[0];
}

TEST(GivenStart, ThatIsCentimetresOffIsNotDoubted) {
  constexpr std::int64_t kBudget = 400;
  for (const char* away : {"10", "25"}) {
    PluginLoader plugins;
    const std::vector<std::string> overrides{
        "evaluate.backend=cpu", "budget.evaluations=" + std::to_string(kBudget),
        "init={from: truth, away_mm: " + std::string(away) + ", away_deg: 10}",
        "source.cameras={width: 640, height: 360, focal_px: 350, baseline_mm: 120}"};
    OpenedScene session =
        open_scene(test::source_dir() / "configs/scenes/real_time.yaml", overrides, plugins);
    const Frame frame = session.source->next().value();
    SceneTracker tracker(*session.scene, std::move(session.parts), initial_state(session, frame),
                         session.seed);
    const Solution solution = tracker.track(frame);
    EXPECT_EQ(solution.status, Status::tracked) << away << " mm off";
    EXPECT_LE(solution.evaluations, 8 * kBudget) << "more than the eight first searches";
    const Eigen::Matrix3Xd truth = session.scene->landmarks(frame.truth->state);
    EXPECT_LT((solution.landmarks - truth).colwise().norm().mean(), 0.005) << away << " mm off";
    EXPECT_TRUE(tracker.take_start_notes().empty()) << away << " mm off";
  }
}

TEST(LookedFor, TrackedModelsThatAStarterSeesElsewhereMoveThere) {
  EXPECT_GT(last_error_of_a_believer(0), 0.05);
  EXPECT_LT(last_error_of_a_believer(0.1), 0.01);
}

}  // namespace
}  // namespace hypotrack
