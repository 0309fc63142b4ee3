#include "shape/landmark_problem.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "shaped_model.hpp"

namespace hypotrack {
namespace {

std::vector<Eigen::Matrix3Xd> labels(const Scene& truth, int frames) {
  std::mt19937_64 random(3);
  std::vector<Eigen::Matrix3Xd> all;
  for (int k = 0; k < frames; ++k)
    all.push_back(truth.landmarks(test::random_state(truth, random)));
  return all;
}

TEST(LandmarkProblem, FindsTheShapeThatTheLabelsHave) {
  const Scene truth = test::shaped_scene({1.08, 0.9});
  const Scene scene = test::shaped_scene();
  const ShapeTargets targets(scene, {}, {});
  LandmarkProblem problem(scene, targets, labels(truth, 5));
  const JointTrial start = problem.start();
  const JointFit fit = fit_jointly(problem, start, targets.prior(1e-3), 40);
  EXPECT_NEAR(fit.best.shape[0], 1.08, 2e-3);
  EXPECT_NEAR(fit.best.shape[1], 0.9, 4e-3);
  EXPECT_GT(problem.mean_distance(start), 2e-3);
  EXPECT_LT(problem.mean_distance(fit.best), 3e-4);
}

TEST(LandmarkProblem, DoesWithoutUnknownLandmarks) {
  const Scene truth = test::shaped_scene({1.08, 0.9});
  const Scene scene = test::shaped_scene();
  const ShapeTargets targets(scene, {}, {"scale"});
  std::vector<Eigen::Matrix3Xd> known = labels(test::shaped_scene({1.08, 1}), 3);
  for (auto& frame : known) frame.col(3).setConstant(std::numeric_limits<double>::quiet_NaN());
  LandmarkProblem problem(scene, targets, known);
  const JointFit fit = fit_jointly(problem, problem.start(), targets.prior(1e-3), 40);
  ASSERT_EQ(fit.best.shape.size(), 1);
  EXPECT_NEAR(fit.best.shape[0], 1.08, 2e-3);
}

}  // namespace
}  // namespace hypotrack
