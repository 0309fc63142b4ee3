// A tracker that is given no start looks for the models.

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "hypotrack/error.hpp"
#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

struct Found {
  Status status;
  double error;  ///< mean over the landmarks, metres
};

/// Tracks frames of real_time.yaml in small pictures, with global_search as its start.
std::vector<Found> track(int frames, std::vector<std::string> overrides) {
  PluginLoader plugins;
  overrides.insert(overrides.end(),
                   {"evaluate.backend=cpu", "init={from: global_search}",
                    "source.cameras={width: 640, height: 360, focal_px: 350, baseline_mm: 120}"});
  OpenedScene session =
      open_scene(test::source_dir() / "configs/scenes/real_time.yaml", overrides, plugins);
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
  const std::vector<Found> found = track(2, {});
  EXPECT_EQ(found[0].status, Status::tracked);
  EXPECT_LT(found[0].error, 0.010);
  EXPECT_LT(found[1].error, 0.005);
}

TEST(LookedFor, HandIsFoundWhenItAppears) {
  const std::vector<Found> found = track(5, {"source.faults=[{frames: [0, 1], kind: absent}]"});
  EXPECT_NE(found[0].status, Status::tracked);
  EXPECT_NE(found[1].status, Status::tracked);
  EXPECT_EQ(found[4].status, Status::tracked);
  EXPECT_LT(found[4].error, 0.010);
}

TEST(LookedFor, ModelsNeedTwoViewsAndARecovery) {
  EXPECT_THROW(track(1, {"tracker.recovery.enabled=false"}), ConfigError);
  EXPECT_THROW(track(1, {"tracker.evidence=false"}), ConfigError);
}

}  // namespace
}  // namespace hypotrack
