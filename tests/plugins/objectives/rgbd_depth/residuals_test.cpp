#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "depth_scene.hpp"
#include "every_target.hpp"
#include "rgbd_depth.hpp"
#include "score.hpp"
#include "test_models.hpp"
#include "written_residuals.hpp"

namespace hypotrack::rgbd_depth {
namespace {

constexpr float kNear = 0.45f, kFar = 0.47f;  // half of d_M apart

Observation observe_row(const Grid& depth, const std::vector<int>& foreground) {
  Observation observation = blank_observation(4);
  observation.views[0].depth = image(depth);
  observation.views[0].mask = cv::Mat1b(4, 4, uchar{0});
  for (const int i : foreground) observation.views[0].mask.at<uchar>(i / 4, i % 4) = 255;
  return observation;
}

TEST(Residuals, AreWhatEveryPixelIsOff) {
  // Foreground in the first five pixels, the fifth without depth.
  Grid depth(16, 0.0f);
  for (const int i : {0, 1, 2, 3, 8}) depth[static_cast<std::size_t>(i)] = kNear;
  const Observation observation = observe_row(depth, {0, 1, 2, 3, 4});
  RgbdDepth objective({});
  objective.prepare(observation);
  Grid drawn(16, 0.0f);
  drawn[0] = kNear;
  drawn[1] = kFar;
  drawn[2] = 1.0f;
  drawn[8] = kNear;  // on background
  const Drawn hypothesis({drawn});
  const double wrong = std::sqrt(100 * 0.04 / 5 + 20 / (2 * 5.0));
  const std::vector<double> expected = {
      0, 0.5 * wrong, wrong, wrong, std::sqrt(2.0), 0, 0, 0, wrong, 0, 0, 0, 0, 0, 0, 0};
  test::on_every_target(compiled_targets(), [&] {
    const std::vector<float> found = test::written_residuals(objective, hypothesis.hypothesis());
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-5) << i;
  });
}

TEST(Residuals, ChangeSignWithTheSurface) {
  const Grid depth(16, kNear), behind(16, kFar), before(16, 2 * kNear - kFar);
  const Observation observation = observe_row(depth, {5, 6});
  RgbdDepth objective({});
  objective.prepare(observation);
  const auto far = test::written_residuals(objective, Drawn({behind}).hypothesis());
  const auto near = test::written_residuals(objective, Drawn({before}).hypothesis());
  EXPECT_GT(far[5], 0);
  EXPECT_NEAR(far[5], -near[5], 1e-5);
}

TEST(Residuals, AreZeroOutsideOfTheImage) {
  Observation observation = observe_row(Grid(16, kNear), {5});
  observation.views[0].valid.setTo(0);
  RgbdDepth objective({});
  objective.prepare(observation);
  for (const float r : test::written_residuals(objective, Drawn({Grid(16, kFar)}).hypothesis()))
    EXPECT_EQ(r, 0);
}

TEST(Residuals, OfAFingerThatCrossesAnotherAreSquaredItsTermAtATenthOfARadian) {
  const Scene scene({{"hand", std::make_shared<const Model>(test::make_test_hand())}});
  Observation observation = observe_row(Grid(16, kNear), {5});
  observation.scene = &scene;
  observation.start = scene.rest_state();
  RgbdDepth objective({});
  objective.prepare(observation);
  const std::vector<FingerPair> pairs = adjacent_fingers(scene);
  ASSERT_EQ(pairs.size(), 3u);
  ASSERT_EQ(objective.residual_count(), 16 + 3);
  Eigen::VectorXd state = scene.rest_state();
  for (const FingerPair& pair : pairs) state[pair.first] = state[pair.second] = 0;
  state[pairs.back().second] += 0.1;
  const Drawn drawn({Grid(16, kNear)});
  const auto found = test::written_residuals(
      objective,
      {{state.data(), static_cast<std::size_t>(state.size())}, drawn.hypothesis().views});
  EXPECT_NEAR(found.back() * found.back(), 10 * 0.1, 1e-5);
  EXPECT_EQ(found[found.size() - 2], 0);
}

}  // namespace
}  // namespace hypotrack::rgbd_depth
