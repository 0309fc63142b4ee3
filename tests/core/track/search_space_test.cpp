#include "track/search/search_space.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <random>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/search.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

Eigen::Quaterniond rotation_of(const Eigen::VectorXd& state, int offset) {
  return {state[offset + 3], state[offset + 4], state[offset + 5], state[offset + 6]};
}

TEST(SearchSpace, QuaternionsAreSearchedComponentByComponent) {
  const Scene scene = test::make_hand_and_box();
  EXPECT_EQ(SearchSpace(scene, {}).dimension(), 34);
}

TEST(SearchSpace, TangentSpaceNeedsOneDimensionLessPerRotation) {
  const Scene scene = test::make_hand_and_box();
  SearchSettings settings;
  settings.rotation_as = RotationCoordinates::tangent;
  EXPECT_EQ(SearchSpace(scene, settings).dimension(), 32);
}

TEST(SearchSpace, SpreadsAreThoseOfTheParameterKinds) {
  const Scene scene = test::make_hand_and_box();
  const SearchRegion region = SearchSpace(scene, {}).region(scene.rest_state());
  EXPECT_DOUBLE_EQ(region.spread[0], 0.040);
  EXPECT_DOUBLE_EQ(region.spread[3], std::sin(5 * kDegree));
  EXPECT_DOUBLE_EQ(region.spread[7], 10 * kDegree);
  EXPECT_DOUBLE_EQ(region.spread[27], 0.040);
}

TEST(SearchSpace, JointsThatSlideSpreadAndReachAsPositionsDo) {
  const Scene scene({{"cabinet", std::make_shared<Model>(test::make_test_cabinet())}});
  const SearchSpace space(scene, {});
  EXPECT_DOUBLE_EQ(space.region(scene.rest_state()).spread[7], 0.040);
  EXPECT_DOUBLE_EQ(space.region(scene.rest_state()).spread[8], 10 * kDegree);
  const SearchRegion near = space.region(scene.rest_state(), Reach{0.02, 1, 1});
  EXPECT_DOUBLE_EQ(near.lower[7], -0.01);
  EXPECT_DOUBLE_EQ(near.upper[7], 0.02);
  EXPECT_DOUBLE_EQ(near.lower[9], -1) << "a joint that turns without end";
}

TEST(SearchSpace, BoundsAreTheModelsOwn) {
  const Scene scene = test::make_hand_and_box();
  const SearchRegion region = SearchSpace(scene, {}).region(scene.rest_state());
  for (int i = 0; i < scene.dimension(); ++i) {
    EXPECT_EQ(region.lower[i], scene.parameters()[static_cast<std::size_t>(i)].lower) << i;
    EXPECT_EQ(region.upper[i], scene.parameters()[static_cast<std::size_t>(i)].upper) << i;
  }
}

TEST(SearchSpace, APriorOutsideTheBoundsStartsOnThem) {
  const Scene scene = test::make_hand_and_box();
  Eigen::VectorXd prior = scene.rest_state();
  prior[8] = 100;
  const SearchRegion region = SearchSpace(scene, {}).region(prior);
  EXPECT_EQ(region.start[8], region.upper[8]);
}

TEST(SearchSpace, GroupsAreThePosesAndLimbsOfTheModels) {
  const Scene scene = test::make_hand_and_box();
  SearchSettings settings;
  const auto quaternion = SearchSpace(scene, settings).region(scene.rest_state()).groups;
  ASSERT_EQ(quaternion.size(), 7u);
  EXPECT_EQ(quaternion[0].kind, SearchGroup::Kind::pose);
  EXPECT_EQ(quaternion[0].dimensions, (std::vector<int>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(quaternion[5].kind, SearchGroup::Kind::limb);
  EXPECT_EQ(quaternion[5].dimensions, (std::vector<int>{23, 24, 25, 26}));
  EXPECT_EQ(quaternion[6].kind, SearchGroup::Kind::pose);
  EXPECT_EQ(quaternion[6].dimensions, (std::vector<int>{27, 28, 29, 30, 31, 32, 33}));

  settings.rotation_as = RotationCoordinates::tangent;
  const auto tangent = SearchSpace(scene, settings).region(scene.rest_state()).groups;
  ASSERT_EQ(tangent.size(), 7u);
  EXPECT_EQ(tangent[0].dimensions, (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(tangent[1].dimensions, (std::vector<int>{6, 7, 8, 9}));
  EXPECT_EQ(tangent[6].dimensions, (std::vector<int>{26, 27, 28, 29, 30, 31}));
}

class BothParametrisations : public testing::TestWithParam<RotationCoordinates> {};

TEST_P(BothParametrisations, EveryDimensionIsInOneGroup) {
  const Scene scene = test::make_hand_and_box();
  SearchSettings settings;
  settings.rotation_as = GetParam();
  const SearchSpace space(scene, settings);
  EXPECT_EQ(group_of_dimension(space.region(scene.rest_state())).size(),
            static_cast<std::size_t>(space.dimension()));
}

TEST_P(BothParametrisations, TheStartIsThePrior) {
  const Scene scene = test::make_hand_and_box();
  std::mt19937_64 random(1);
  const Eigen::VectorXd prior = test::random_state(scene, random);
  SearchSettings settings;
  settings.rotation_as = GetParam();
  const SearchSpace space(scene, settings);
  const Eigen::MatrixXd states = space.states(space.region(prior).start, prior);
  EXPECT_LT((states.col(0) - prior).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_P(BothParametrisations, ThePointOfAStateLeadsBackToIt) {
  const Scene scene = test::make_hand_and_box();
  std::mt19937_64 random(3);
  SearchSettings settings;
  settings.rotation_as = GetParam();
  for (const std::vector<bool>& moving : {std::vector<bool>{true, true}, {false, true}}) {
    const SearchSpace space(scene, settings, moving);
    for (int i = 0; i < 20; ++i) {
      const Eigen::VectorXd prior = test::random_state(scene, random);
      Eigen::VectorXd state = test::random_state(scene, random);
      if (!moving[0]) state.head<27>() = prior.head<27>();
      const Eigen::VectorXd found = space.states(space.point(state, prior), prior);
      for (const auto& item : scene.items())  // q and -q are one rotation
        if (rotation_of(found, item.offset).dot(rotation_of(state, item.offset)) < 0)
          state.segment<4>(item.offset + 3) *= -1;
      EXPECT_LT((found - state).cwiseAbs().maxCoeff(), 1e-9);
    }
  }
}

TEST_P(BothParametrisations, StatesHaveUnitQuaternions) {
  const Scene scene = test::make_hand_and_box();
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  SearchSettings settings;
  settings.rotation_as = GetParam();
  const SearchSpace space(scene, settings);
  Eigen::MatrixXd points(space.dimension(), 20);
  for (auto& x : points.reshaped()) x = normal(random);
  const Eigen::MatrixXd states = space.states(points, scene.rest_state());
  for (Eigen::Index n = 0; n < states.cols(); ++n)
    for (const auto& item : scene.items())
      EXPECT_NEAR(rotation_of(states.col(n), item.offset).norm(), 1, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(SearchSpace, BothParametrisations,
                         testing::Values(RotationCoordinates::quaternion,
                                         RotationCoordinates::tangent));

TEST(SearchSpace, APointOfAnotherSizeIsTheOptimizersMistake) {
  const Scene scene = test::make_hand_and_box();
  const Eigen::VectorXd short_one = Eigen::VectorXd::Zero(2);
  EXPECT_EQ(test::message_of<PluginError>(
                [&] { SearchSpace(scene, {}).states(short_one, scene.rest_state()); }),
            "the optimizer gave a point of 2 numbers, the search has 34; this is a bug in the "
            "optimizer");
}

TEST(SearchSpace, ATangentVectorIsARotationByItsLengthAboutItself) {
  const Scene scene({{"box", std::make_shared<Model>(test::make_test_box())}});
  SearchSettings settings;
  settings.rotation_as = RotationCoordinates::tangent;
  const SearchSpace space(scene, settings);
  std::mt19937_64 random(3);
  const Eigen::VectorXd prior = test::random_state(scene, random);
  Eigen::VectorXd point = space.region(prior).start;
  point.segment<3>(3) << 0, 0.3, 0;
  const Eigen::VectorXd state = space.states(point, prior).col(0);
  const Eigen::Quaterniond expected =
      rotation_of(prior, 0) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY());
  EXPECT_LT(rotation_of(state, 0).angularDistance(expected), 1e-12);
}

TEST(SearchSpace, ModelsThatDoNotMoveKeepWhatThePriorHas) {
  const Scene scene = test::make_hand_and_box();
  SearchSettings settings;
  for (const auto as : {RotationCoordinates::quaternion, RotationCoordinates::tangent}) {
    settings.rotation_as = as;
    const SearchSpace space(scene, settings, {false, true});
    const Eigen::VectorXd prior = scene.rest_state();
    const SearchRegion region = space.region(prior);
    ASSERT_EQ(space.dimension(), as == RotationCoordinates::tangent ? 6 : 7);
    ASSERT_EQ(region.groups.size(), 1U);
    EXPECT_EQ(std::ssize(region.groups[0].dimensions), space.dimension());
    Eigen::VectorXd point = region.start;
    point[1] += 0.02;
    const Eigen::VectorXd state = space.states(point, prior);
    EXPECT_EQ(state.head(27), prior.head(27));
    EXPECT_NEAR(state[28], prior[28] + 0.02, 1e-12);
  }
}

}  // namespace
}  // namespace hypotrack
