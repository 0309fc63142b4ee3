// A gap in time and missing frames are the same to a tracker.

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

constexpr int kFirst = 10, kBehind = 22, kFrames = 30;  // 12 frames at 30 Hz: 0.4 s
enum class Gap { missing_frames, no_frames, no_frames_and_no_numbers };

/// Tracks a hand that moves on unseen; returns the solutions behind the gap.
std::vector<Solution> behind(Gap gap, std::vector<std::string> overrides) {
  PluginLoader plugins;
  overrides.insert(
      overrides.end(),
      {"evaluate.backend=cpu",
       "source.cameras={width: 640, height: 360, focal_px: 350, baseline_mm: 120}",
       "source.keyframes=[{frame: 0, gesture: open, pose: {hand: {position_mm: [0, 80, 520],"
       " rotation_deg: [180, 0, 0]}}}, {frame: 9, gesture: open, pose: {hand: {position_mm: [-10,"
       " 85, 520], rotation_deg: [175, 0, 6]}}}, {frame: 22, gesture: spread, pose: {hand:"
       " {position_mm: [100, 80, 490], rotation_deg: [175, 0, 6]}}}, {frame: 50, gesture: open}]"});
  OpenedScene session =
      open_scene(test::source_dir() / "configs/scenes/real_time.yaml", overrides, plugins);
  std::optional<SceneTracker> tracker;
  std::vector<Solution> out;
  for (int i = 0; i < kFrames; ++i) {
    Frame frame = session.source->next().value();
    const bool in_gap = i >= kFirst && i < kBehind;
    if (in_gap && gap != Gap::missing_frames) continue;
    if (in_gap) frame.views.clear();
    if (i >= kBehind && gap == Gap::no_frames_and_no_numbers) frame.index -= kBehind - kFirst;
    if (!tracker)
      tracker.emplace(*session.scene, std::move(session.parts), initial_state(session, frame),
                      session.seed);
    const Solution solution = tracker->track(frame);
    if (i >= kBehind) out.push_back(solution);
  }
  return out;
}

void expect_alike(std::vector<std::string> overrides) {
  const auto missing = behind(Gap::missing_frames, overrides);
  const auto gap = behind(Gap::no_frames, overrides);
  ASSERT_EQ(missing.size(), gap.size());
  for (std::size_t i = 0; i < gap.size(); ++i) {
    EXPECT_EQ(missing[i].status, gap[i].status) << i;
    EXPECT_EQ(missing[i].state, gap[i].state) << i;
    EXPECT_EQ(missing[i].evaluations, gap[i].evaluations) << i;
    EXPECT_EQ(missing[i].probabilities, gap[i].probabilities) << i;
  }
}

TEST(Gap, IsTrackedAcrossAsMissingFramesOfThatTimeAre) { expect_alike({}); }

TEST(Gap, IsPredictedAndSmoothedAcrossAsMissingFramesOfThatTimeAre) {
  expect_alike({"search.prediction={velocity: constant, longest_gap_ms: 1000}",
                "output.smoothing.enabled=true", "uncertainty.enabled=true",
                "budget.evaluations=120"});
}

TEST(Gap, IsAsLongAsTheTimesSayWhateverTheFramesNumbers) {
  const auto found = behind(Gap::no_frames_and_no_numbers, {});
  const auto missing = behind(Gap::missing_frames, {});
  EXPECT_EQ(found.back().status, Status::tracked);
  EXPECT_EQ(missing.back().status, Status::tracked);
  // Another number draws other random numbers, so the fingers may end a little apart.
  EXPECT_LT((found.back().landmarks - missing.back().landmarks).colwise().norm().mean(), 0.015);
}

}  // namespace
}  // namespace hypotrack
