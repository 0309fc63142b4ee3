// The real-time tracker on a rendered hand whose fingers a card hides for some frames.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "output/metrics/landmark_errors.hpp"
#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

constexpr int kCardFrom = 8, kCardUntil = 21;  // frames with the card

struct CardFrame {
  Status status;
  std::vector<bool> hidden;
  double error_mm, moved_mm;
};

/// Tracks an open hand. `cover` is what the card looks like.
std::vector<CardFrame> track_behind_card(const std::string& cover) {
  PluginLoader plugins;
  const std::vector<std::string> overrides = {
      "evaluate.backend=cpu",
      "source.cameras={width: 640, height: 360, focal_px: 350, baseline_mm: 120}",
      "source.keyframes=[{frame: 0, gesture: open, pose: {hand: {position_mm: [60, 80, 500], "
      "rotation_deg: [180, 0, 0]}}}, {frame: 30, pose: {hand: {position_mm: [45, 88, 490]}}}]",
      fmt::format("source.cards=[{{frames: [{}, {}], at_mm: [60, -70, 420], size_mm: [170, 115], "
                  "{}}}]",
                  kCardFrom, kCardUntil, cover)};
  OpenedScene session =
      open_scene(test::source_dir() / "configs/scenes/real_time.yaml", overrides, plugins);
  const Scene& scene = *session.scene;
  const LandmarkLayout layout = landmark_layout(scene.landmark_names());
  std::optional<SceneTracker> tracker;
  std::vector<CardFrame> out;
  Eigen::Matrix3Xd before;
  for (int i = 0; i < 28; ++i) {
    const Frame frame = session.source->next().value();
    if (!tracker)
      tracker.emplace(scene, std::move(session.parts), initial_state(session, frame), session.seed);
    const Solution s = tracker->track(frame);
    const Eigen::Matrix3Xd now = scene.landmarks(s.state);
    const Eigen::Matrix3Xd truth = scene.landmarks(frame.truth->state);
    out.push_back({s.status, s.hidden, 1000 * frame_error(layout, now, truth).mean,
                   i > 0 ? 1000 * frame_error(layout, now, before).mean : 0});
    before = now;
  }
  return out;
}

void expect_never_wrong(const std::vector<CardFrame>& frames) {
  std::string text;
  for (const CardFrame& f : frames)
    text += fmt::format("{}{:.1f} ", to_string(f.status).substr(0, 1), f.error_mm);
  for (int i = 0; i < std::ssize(frames); ++i) {
    const CardFrame& f = frames[static_cast<std::size_t>(i)];
    EXPECT_NE(f.status, Status::lost) << "frame " << i << " of " << text;
    EXPECT_LT(f.error_mm, 12) << "frame " << i << " of " << text;
    EXPECT_LT(f.moved_mm, 12) << "frame " << i << " of " << text;
    if (i < kCardFrom || i > kCardUntil + 3) {
      EXPECT_EQ(f.status, Status::tracked) << "frame " << i << " of " << text;
      EXPECT_TRUE(f.hidden.empty()) << "frame " << i << " of " << text;
    } else if (i > kCardFrom && i <= kCardUntil) {
      EXPECT_GE(std::ranges::count(f.hidden, true), 8) << "frame " << i << " of " << text;
    }
  }
  // Fingers may do anything behind a card.
  EXPECT_EQ(frames[kCardFrom + 1].status, Status::tracked) << text;
  EXPECT_EQ(frames[kCardUntil].status, Status::uncertain) << text;
}

TEST(Card, FingersBehindAPlainOneStayWhereTheyWere) {
  expect_never_wrong(track_behind_card("color: [120, 122, 118]"));
}

TEST(Card, FingersBehindAPatternStayWhereTheyWere) {
  expect_never_wrong(track_behind_card("pattern: 1"));
}

}  // namespace
}  // namespace hypotrack
