// The real-time tracker on short rendered sequences in which a hand is away for a while.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "output/metrics/landmark_errors.hpp"
#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

struct Tracked {
  Status status;
  double error_mm;  ///< NaN where the hand is away
  bool absent;
  double jump_mm;  ///< of the wrist since the frame before
  double sigma_mm;
};

/// Tracks frames of a scene of configs/ with one hand.
std::vector<Tracked> track_scene(const std::string& scene_file, int frames,
                                 std::vector<std::string> overrides) {
  PluginLoader plugins;
  overrides.push_back("evaluate.backend=cpu");
  OpenedScene session =
      open_scene(test::source_dir() / "configs/scenes" / scene_file, overrides, plugins);
  const Scene& scene = *session.scene;
  const LandmarkLayout layout = landmark_layout(scene.landmark_names());
  std::optional<SceneTracker> tracker;
  std::vector<Tracked> out;
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (int i = 0; i < frames; ++i) {
    const Frame frame = session.source->next().value();
    if (!tracker)
      tracker.emplace(scene, std::move(session.parts), initial_state(session, frame), session.seed);
    const Solution s = tracker->track(frame);
    const bool absent = !frame.truth->absent.empty() && frame.truth->absent[0];
    const double error = absent ? std::nan("")
                                : 1000 * frame_error(layout, scene.landmarks(s.state),
                                                     scene.landmarks(frame.truth->state))
                                             .mean;
    const Eigen::Vector3d wrist = s.state.head<3>();
    out.push_back({s.status, error, absent, i == 0 ? 0 : 1000 * (wrist - last).norm(),
                   s.sigma.size() > 0 ? 1000 * s.sigma.mean() : std::nan("")});
    last = wrist;
  }
  return out;
}

/// Tracks frames of configs/scenes/real_time.yaml in small pictures.
std::vector<Tracked> track(int frames, std::vector<std::string> overrides) {
  overrides.push_back("source.cameras={width: 640, height: 360, focal_px: 350, baseline_mm: 120}");
  return track_scene("real_time.yaml", frames, std::move(overrides));
}

std::string statuses(const std::vector<Tracked>& frames) {
  std::string out;
  for (const Tracked& f : frames)
    out += fmt::format("{}{} ", to_string(f.status).substr(0, 1),
                       f.absent ? "-" : fmt::format("{:.0f}", f.error_mm));
  return out;
}

/// What every sequence promises: nothing wrong is called tracked, and the end is right.
void expect_found_again(const std::vector<Tracked>& frames, int returns_at) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Tracked& f = frames[i];
    if (f.status == Status::tracked) {
      EXPECT_FALSE(f.absent) << "frame " << i << " of " << statuses(frames);
      EXPECT_FALSE(f.error_mm > 20) << "frame " << i << " of " << statuses(frames);
    }
  }
  const auto back = frames.begin() + returns_at;
  EXPECT_TRUE(std::any_of(back, std::min(back + 10, frames.end()), [](const Tracked& f) {
    return f.status == Status::tracked && f.error_mm < 20;
  })) << statuses(frames);
  EXPECT_EQ(frames.back().status, Status::tracked) << statuses(frames);
  EXPECT_LT(frames.back().error_mm, 10) << statuses(frames);
}

std::string absent(int first, int last) {
  return fmt::format("source.faults=[{{frames: [{}, {}], kind: absent}}]", first, last);
}

TEST(Lost, TracksDarkPictures) {
  const auto frames = track(6, {"source.sensor={noise_sigma: 1.5, gain: [0.15, 0.15]}"});
  for (const Tracked& f : frames) {
    EXPECT_EQ(f.status, Status::tracked) << statuses(frames);
    EXPECT_LT(f.error_mm, 10) << statuses(frames);
  }
}

TEST(Lost, FollowsFastHandsAtFifteenPairsASecond) {
  std::string dropped;  // every second pair of 30 a second
  for (int frame = 1; frame < 32; frame += 2)
    dropped += fmt::format("{{frames: [{0}, {0}], kind: missing}}, ", frame);
  const auto frames =
      track_scene("datasets/shf.yaml", 16,
                  {"tracker=@trackers/recommended", "source.faults=[" + dropped + "]"});
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].status, Status::tracked) << i;
    EXPECT_LT(frames[i].error_mm, 4) << i;
  }
}

TEST(Lost, ComesBackAfterOneFrameWithoutTheHand) {
  const auto frames = track(24, {absent(10, 10)});
  expect_found_again(frames, 11);
}

TEST(Lost, ComesBackAfterThreeFramesWithoutTheHandAndSaysHowFarItMayBe) {
  const auto frames =
      track(26, {absent(10, 12), "uncertainty.enabled=true", "budget.evaluations=120"});
  expect_found_again(frames, 13);
  for (const Tracked& f : frames) {
    if (f.status == Status::lost || f.status == Status::absent) {
      EXPECT_GT(f.sigma_mm, 20);
    }
    EXPECT_LT(f.jump_mm, 150) << statuses(frames);
  }
}

TEST(Lost, SaysThatTheHandIsAwayForHalfASecondAndFindsItInTheSamePlace) {
  const auto frames = track(
      40,
      {absent(10, 25),
       "source.keyframes=[{frame: 0, gesture: open, pose: {hand: {position_mm: [60, 80, 500],"
       " rotation_deg: [180, 0, 0]}}}, {frame: 9, gesture: spread, pose: {hand: {position_mm:"
       " [50, 85, 490], rotation_deg: [175, 0, 6]}}}, {frame: 26, gesture: spread, pose: {hand:"
       " {position_mm: [50, 85, 490], rotation_deg: [175, 0, 6]}}}, {frame: 50, gesture: open}]"});
  expect_found_again(frames, 26);
}

TEST(Lost, SaysThatAHandHasLeftThePicturesThoughTheyShowItsColours) {
  const auto frames = track(
      26, {"source.frames=26", "source.background={kind: procedural, seed: 4}",
           "source.keyframes=[{frame: 0, gesture: open, pose: {hand: {position_mm: [60, 80, 500],"
           " rotation_deg: [180, 0, 0]}}}, {frame: 4, gesture: open}, {frame: 20, gesture: open,"
           " pose: {hand: {position_mm: [900, 80, 500], rotation_deg: [180, 0, 0]}}}]"});
  EXPECT_EQ(frames[4].status, Status::tracked) << statuses(frames);
  for (std::size_t i = 10; i < frames.size(); ++i)
    EXPECT_NE(frames[i].status, Status::tracked) << "frame " << i << " of " << statuses(frames);
  EXPECT_EQ(frames.back().status, Status::absent) << statuses(frames);
}

TEST(Lost, FindsAHandThatComesBackElsewhere) {
  const auto frames = track(
      40,
      {absent(10, 25),
       "source.keyframes=[{frame: 0, gesture: open, pose: {hand: {position_mm: [0, 80, 520],"
       " rotation_deg: [180, 0, 0]}}}, {frame: 9, gesture: open, pose: {hand: {position_mm: [-10,"
       " 85, 520], rotation_deg: [175, 0, 6]}}}, {frame: 26, gesture: spread, pose: {hand:"
       " {position_mm: [130, 80, 480], rotation_deg: [175, 0, 6]}}}, {frame: 50, gesture: open}]"});
  expect_found_again(frames, 26);
}

TEST(Lost, StaysWhereItWasWhileLeftAndRightAreExchanged) {
  const auto frames = track(26, {"source.faults=[{frames: [10, 14], kind: exchanged}]"});
  expect_found_again(frames, 15);
  for (std::size_t i = 10; i < 15; ++i) {
    EXPECT_NE(frames[i].status, Status::tracked) << statuses(frames);
    EXPECT_LT(frames[i].jump_mm, 150) << statuses(frames);
  }
}

TEST(Lost, FindsAFistWhereAPalmWas) {
  const auto frames = track(
      38,
      {absent(10, 21),
       "source.keyframes=[{frame: 0, gesture: open, pose: {hand: {position_mm: [60, 80, 500],"
       " rotation_deg: [180, 0, 0]}}}, {frame: 9, gesture: open, pose: {hand: {position_mm: [50,"
       " 85, 490], rotation_deg: [175, 0, 6]}}}, {frame: 22, gesture: fist, pose: {hand:"
       " {position_mm: [55, 75, 490], rotation_deg: [175, 5, 0]}}}, {frame: 50, gesture: fist}]"});
  expect_found_again(frames, 22);
}

TEST(Lost, EqualSeedsComeBackAlike) {
  const auto once = track(16, {absent(6, 8)}), again = track(16, {absent(6, 8)});
  EXPECT_EQ(statuses(once), statuses(again));
}

TEST(Lost, SearchesInTheBackgroundWithoutStoppingTheVideo) {
  const auto frames = track(
      250, {absent(10, 12), "recovery.run=background", "source.frames=250",
            "source.keyframes=[{frame: 0, gesture: open, pose: {hand: {position_mm: [60, 80, 500],"
            " rotation_deg: [180, 0, 0]}}}, {frame: 9, gesture: spread, pose: {hand: {position_mm:"
            " [50, 85, 490], rotation_deg: [175, 0, 6]}}}]"});
  EXPECT_TRUE(std::any_of(frames.begin() + 13, frames.end(), [](const Tracked& f) {
    return f.status == Status::tracked && f.error_mm < 20;
  })) << statuses(frames);
  for (const Tracked& f : frames)
    if (f.status == Status::tracked) {
      EXPECT_FALSE(f.absent || f.error_mm > 20) << statuses(frames);
    }
}

TEST(Lost, GoesOnFromAnyAnswerAsThePaperDoesWhereItIsToldTo) {
  const auto frames = track(14, {absent(10, 10), "recovery.enabled=false", "judge=none"});
  EXPECT_TRUE(
      std::ranges::none_of(frames, [](const Tracked& f) { return f.status == Status::absent; }));
}

TEST(Lost, WaitsForAHandThatIsNotThereAtFirst) {
  const auto frames = track(
      24, {absent(0, 11),
           "source.keyframes=[{frame: 0, gesture: open, pose: {hand: {position_mm: [60, 80, 500],"
           " rotation_deg: [180, 0, 0]}}}, {frame: 12, gesture: open}, {frame: 40, gesture: spread,"
           " pose: {hand: {position_mm: [90, 80, 500], rotation_deg: [175, 0, 10]}}}]"});
  expect_found_again(frames, 12);
}

TEST(Lost, WaitsForAHandThatStartsOutOfView) {
  const auto frames = track(
      30, {"source.keyframes=[{frame: 0, gesture: open, pose: {hand: {position_mm: [600, 80, 500],"
           " rotation_deg: [180, 0, 0]}}}, {frame: 12, gesture: open, pose: {hand: {position_mm:"
           " [60, 80, 500], rotation_deg: [180, 0, 0]}}}, {frame: 60, gesture: open}]",
           "init.from=rest",
           "init.pose={hand: {position_mm: [60, 80, 500], rotation_deg: [180, 0, 0]}}"});
  EXPECT_EQ(frames.back().status, Status::tracked) << statuses(frames);
  EXPECT_LT(frames.back().error_mm, 10) << statuses(frames);
}

TEST(Lost, DoesNotSlideIntoASleeve) {
  const auto frames = track(
      19, {"source.keyframes=null", "source.random={seed: 1204, frames: 180}",
           "source.forearm.kind=sleeve", "source.background={kind: procedural, seed: 4}",
           "source.light={ambient: 0.7, diffuse: 0.3, specular: 0, direction: [-0.5, 0.5, 0.7]}",
           "source.sensor={noise_sigma: 2, gain: [1.1, 1], seed: 4}"});
  for (const Tracked& f : frames) EXPECT_LT(f.error_mm, 20) << statuses(frames);
}

TEST(Lost, DoesNotPutAFlatHandOntoAFoldedOneAndItsBareForearm) {
  const std::string demo = (test::source_dir() / "configs/scenes/demo.yaml").string();
  const auto frames = track_scene(
      "datasets/sh.yaml", 3,
      {"objective=@" + demo, "optimizer=@" + demo, "search=@" + demo, "budget.evaluations=1024",
       "source.keyframes=null", "source.random={seed: 3203, frames: 60}",
       "source.forearm.kind=bare", "source.light={ambient: 0.45, diffuse: 0.6, specular: 0.12}",
       "source.sensor={noise_sigma: 3, seed: 3}"});
  for (const Tracked& f : frames) EXPECT_LT(f.error_mm, 20) << statuses(frames);
}

/// What a frame says of each model of a scene.
struct ModelsTracked {
  std::vector<Status> status;
  std::vector<double> error_mm;
};

/// Tracks frames of a scene of configs/ with the terms and the optimizer of real_time.yaml.
/// Adds overrides that take the real-time tracker.
std::vector<std::string> in_real_time(std::vector<std::string> overrides) {
  const std::string scene = (test::source_dir() / "configs/scenes/real_time.yaml").string();
  overrides.insert(overrides.end(), {"objective=@" + scene, "optimizer=@" + scene,
                                     "budget.evaluations=60", "tile.size=128"});
  return overrides;
}

std::vector<ModelsTracked> track_models(const std::string& scene_file, int frames,
                                        std::vector<std::string> overrides) {
  PluginLoader plugins;
  overrides.insert(overrides.end(),
                   {"evaluate.backend=cpu",
                    "source.cameras={width: 640, height: 360, focal_px: 350, baseline_mm: 120}"});
  OpenedScene session =
      open_scene(test::source_dir() / "configs/scenes" / scene_file, overrides, plugins);
  const Scene& scene = *session.scene;
  const LandmarkLayout layout = landmark_layout(scene.landmark_names());
  std::optional<SceneTracker> tracker;
  std::vector<ModelsTracked> out;
  for (int i = 0; i < frames; ++i) {
    const Frame frame = session.source->next().value();
    if (!tracker)
      tracker.emplace(scene, std::move(session.parts), initial_state(session, frame), session.seed);
    const Solution s = tracker->track(frame);
    const FrameError error =
        frame_error(layout, scene.landmarks(s.state), scene.landmarks(frame.truth->state));
    out.push_back({s.models, {}});
    for (const double e : error.models) out.back().error_mm.push_back(1000 * e);
  }
  return out;
}

TEST(Lost, FollowsOneHandWhileTheOtherIsAway) {
  const auto frames =
      track_models("two_hands.yaml", 24,
                   in_real_time({"source.faults=[{frames: [6, 13], kind: absent, model: left}]"}));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].status[0], Status::tracked) << "frame " << i;
    EXPECT_LT(frames[i].error_mm[0], 15) << "frame " << i;
    if (i >= 6 && i <= 13) {
      EXPECT_NE(frames[i].status[1], Status::tracked) << "frame " << i;
    }
  }
  EXPECT_EQ(frames.back().status[1], Status::tracked);
  EXPECT_LT(frames.back().error_mm[1], 20);
}

TEST(Lost, FindsABoxInTheHandThatHeldIt) {
  // Unless it is put back as it was held, the box ends a quarter turn about its long axis off, at
  // 12 mm, with three of twenty seeds. This is one of them.
  const auto frames = track_models("hand_and_box.yaml", 30,
                                   {"source.faults=[{frames: [8, 19], kind: absent}]",
                                    "tracker=@trackers/recommended", "seed=2"});
  constexpr std::size_t kAway = 8, kBack = 20;
  for (std::size_t m = 0; m < 2; ++m) {
    for (std::size_t i = kAway; i < kBack; ++i) {
      EXPECT_NE(frames[i].status[m], Status::tracked) << "frame " << i;
    }
    for (std::size_t i = kBack; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].status[m], Status::tracked) << "model " << m << ", frame " << i;
      EXPECT_LT(frames[i].error_mm[m], 10) << "model " << m << ", frame " << i;
    }
    EXPECT_LT(frames.back().error_mm[m], 3) << "model " << m;
  }
}

}  // namespace
}  // namespace hypotrack
