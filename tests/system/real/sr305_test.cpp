// Real depth frames of a hand without colour: configs/scenes/sr305.yaml. Nobody labelled them, so
// the drawn solutions are held against the depth itself; docs/results/real_pictures.md says what
// the pictures look like.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/api/renderer.hpp"
#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

constexpr float kSameSurface = 0.01f;

/// How a drawn state fits a depth image.
struct Fit {
  double median_mm = 0;  ///< |o_d - r_d| over the drawn pixels that have a depth
  double matched = 0;    ///< share of the drawn pixels within 10 mm of it
};

Fit fit(Renderer& renderer, const Camera& camera, const Eigen::VectorXd& state,
        const cv::Mat& observed) {
  const cv::Mat drawn = renderer.render(state, camera, {.samples = 1}).depth;
  std::vector<float> differences;
  int covered = 0, matched = 0;
  for (int y = 0; y < drawn.rows; ++y) {
    for (int x = 0; x < drawn.cols; ++x) {
      const float r = drawn.at<float>(y, x), o = observed.at<float>(y, x);
      if (r == 0) continue;
      ++covered;
      if (o == 0) continue;
      differences.push_back(std::abs(o - r));
      matched += differences.back() <= kSameSurface;
    }
  }
  if (differences.empty()) return {1e3, 0};
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return {1e3 * double{*middle}, static_cast<double>(matched) / covered};
}

TEST(Sr305, TheHandIsFollowedThroughItsFrames) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  const auto folder = test::shared_data() / "rgbd/hand_recognition_SR305/datasets/custom";
  PluginLoader plugins;
  const std::vector<std::string> overrides = {
      "source.left_depth=" + (folder / "20210326-231615" / "*.png").string(), "source.count=4"};
  OpenedScene session =
      open_scene(test::source_dir() / "configs/scenes/sr305.yaml", overrides, plugins);
  const Camera camera = session.parts.cameras.at(0);
  Frame frame = session.source->next().value();
  const Eigen::VectorXd start = initial_state(session, frame);
  Renderer renderer(*session.scene);
  EXPECT_LT(fit(renderer, camera, start, frame.views[0].depth).median_mm, 5) << "the scene's pose";

  SceneTracker tracker(*session.scene, std::move(session.parts), start, 1);
  Fit stale;
  int frames = 0;
  for (std::optional<Frame> next = frame; next; next = session.source->next()) {
    const cv::Mat& depth = next->views.at(0).depth;
    const Fit found = fit(renderer, camera, tracker.track(*next).state, depth);
    stale = fit(renderer, camera, start, depth);
    fmt::print("frame {}: median {:.1f} mm, {:.0f} % within 10 mm; not moved: {:.0f} %\n",
               next->index, found.median_mm, 100 * found.matched, 100 * stale.matched);
    EXPECT_LT(found.median_mm, 4) << "frame " << next->index;
    EXPECT_GT(found.matched, 0.75) << "frame " << next->index;
    ++frames;
  }
  EXPECT_EQ(frames, 4);
  EXPECT_LT(stale.matched, 0.3) << "the hand did move";
}

}  // namespace
}  // namespace hypotrack
