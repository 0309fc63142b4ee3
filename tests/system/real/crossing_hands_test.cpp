#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hand_detector.hpp"
#include "output/metrics/landmark_errors.hpp"
#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

// Arms and a face of the skin's colour pull at hands that hide each other.
TEST(CrossingHands, AreFollowedBeforeAPerson) {
  if (!std::filesystem::exists(HandDetector::default_folder() / "hand_landmark_full.net"))
    GTEST_SKIP() << "needs the hand detector; run `hypotrack get detector`";
  constexpr int kCrossed = 112;  // frames
  PluginLoader plugins;
  const std::vector<std::string> overrides = {
      "evaluate.backend=cpu", "source.background={kind: procedural, seed: 2, person: {}}"};
  OpenedScene session = open_scene(
      test::source_dir() / "configs/scenes/reality/shirt_two_hands.yaml", overrides, plugins);
  const LandmarkLayout layout = landmark_layout(session.scene->landmark_names());
  const Eigen::VectorXd start = session.scene->rest_state();
  SceneTracker tracker(*session.scene, std::move(session.parts), start, session.seed);
  int lost = 0;
  double worst = 0;
  for (int i = 0; i < kCrossed; ++i) {
    const Frame frame = session.source->next().value();
    const Solution solution = tracker.track(frame);
    lost += solution.status >= Status::lost ? 1 : 0;
    worst = std::max(worst, frame_error(layout, solution.landmarks, frame.truth->landmarks).mean);
  }
  EXPECT_LE(lost, 2);
  EXPECT_LT(worst, 0.010);
}

}  // namespace
}  // namespace hypotrack
