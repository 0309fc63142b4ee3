#include <gtest/gtest.h>

#include <random>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

/// Expects derivatives like central differences of the landmarks, in a random state.
void expect_like_differences(const std::shared_ptr<const Model>& model) {
  constexpr double kStep = 1e-6;
  const Scene scene({{"it", model}});
  std::mt19937_64 random(5);
  const Eigen::VectorXd state = test::random_state(scene, random, {0.1, -0.2, 0.5}, 0.2);
  Eigen::VectorXd here = state;
  scene.normalize(here);
  const auto landmarks = [&](Eigen::Index k, double step) {
    Eigen::VectorXd moved = here;
    moved[k] += step;
    scene.normalize(moved);
    return scene.landmarks(moved).reshaped().eval();
  };
  const Eigen::MatrixXd found =
      landmark_derivatives(*model, {here.data(), static_cast<std::size_t>(here.size())});
  ASSERT_EQ(found.rows(), 3 * std::ssize(model->data().landmarks));
  ASSERT_EQ(found.cols(), here.size());
  for (Eigen::Index k = 0; k < here.size(); ++k) {
    Eigen::VectorXd along = Eigen::VectorXd::Unit(here.size(), k);
    const Eigen::Vector4d q = here.segment<4>(3);
    along.segment<4>(3) -= (q * q.dot(along.segment<4>(3))).eval();  // on the unit sphere
    const Eigen::VectorXd expected = (landmarks(k, kStep) - landmarks(k, -kStep)) / (2 * kStep);
    EXPECT_LT((found * along - expected).cwiseAbs().maxCoeff(), 1e-7)
        << scene.parameters()[static_cast<std::size_t>(k)].name;
  }
}

TEST(LandmarkDerivatives, AreDifferencesOfAHandsLandmarks) {
  expect_like_differences(std::make_shared<Model>(test::make_test_hand()));
}

TEST(LandmarkDerivatives, AreDifferencesWhereJointsSlideTurnOnAndMimicOthers) {
  expect_like_differences(std::make_shared<Model>(test::make_test_cabinet()));
}

}  // namespace
}  // namespace hypotrack
