#include "shape/shape_targets.hpp"

#include <gmock/gmock.h>

#include "hypotrack/api/error.hpp"
#include "shaped_model.hpp"

namespace hypotrack {
namespace {

/// Two hands and a box.
Scene two_hands() {
  return Scene({{"left", std::make_shared<test::ShapedHand>()},
                {"box", std::make_shared<Model>(test::make_test_box())},
                {"right", std::make_shared<test::ShapedHand>()}});
}

TEST(ShapeTargets, AreAllModelsWithAShape) {
  const Scene scene = two_hands();
  const ShapeTargets targets(scene, {}, {});
  EXPECT_THAT(targets.models(), ::testing::ElementsAre(0, 2));
  ASSERT_EQ(targets.wanted().size(), 2u);
  EXPECT_EQ(targets.wanted()[1].name, "index");
}

TEST(ShapeTargets, ReshapeTheirModelsAndNoOthers) {
  const Scene scene = two_hands();
  const ShapeTargets targets(scene, {"right"}, {"index"});
  const auto other = targets.reshaped(scene, Eigen::VectorXd::Constant(1, 1.2));
  EXPECT_EQ(other->items()[0].model, scene.items()[0].model);
  EXPECT_EQ(other->items()[1].model, scene.items()[1].model);
  EXPECT_EQ(other->items()[2].model->data().mesh.vertices,
            test::ShapedHand({1, 1.2}).data().mesh.vertices);
  EXPECT_EQ(other->dimension(), scene.dimension());
}

TEST(ShapeTargets, AreThinnerByWhatIsAskedFor) {
  const Scene scene = two_hands();
  const ShapeTargets targets(scene, {"right"}, {});
  const auto as_it_is = targets.reshaped(scene, targets.values());
  const auto thinner = targets.reshaped(scene, targets.values(), 0.002);
  const Eigen::Matrix3Xf& full = as_it_is->items()[2].model->data().mesh.vertices;
  const Eigen::Matrix3Xf& thin = thinner->items()[2].model->data().mesh.vertices;
  EXPECT_TRUE((full - thin).colwise().norm().isApproxToConstant(0.002f, 1e-3f));
  EXPECT_EQ(thinner->items()[2].model->data().simplified.vertices, thin);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT(thin.row(axis).maxCoeff(), full.row(axis).maxCoeff() - 0.0005f) << axis;
    EXPECT_GT(thin.row(axis).minCoeff(), full.row(axis).minCoeff() + 0.0005f) << axis;
  }
  EXPECT_EQ(thinner->items()[2].model->data().landmarks[1].position,
            as_it_is->items()[2].model->data().landmarks[1].position);
  EXPECT_EQ(thinner->items()[0].model, scene.items()[0].model);
}

TEST(ShapeTargets, LearnNothingFromAnUnsoughtParameter) {
  const Scene scene = test::shaped_scene();
  const ShapePrior both = ShapeTargets(scene, {}, {}).prior(1);
  const ShapePrior alone = ShapeTargets(scene, {}, {"index"}).prior(1);
  EXPECT_NEAR(alone.precision(0, 0), 1 / (0.05 * 0.05), 1e-9);
  EXPECT_NEAR(both.precision.inverse()(1, 1), 0.05 * 0.05, 1e-12);
  EXPECT_NEAR(both.precision.inverse()(1, 0), -0.3 * 0.07 * 0.05, 1e-12);
}

TEST(ShapeCorrelations, AreThoseOfEachParameterWithTheOnesBeforeIt) {
  const std::vector<ShapeParameter> all = {
      {.name = "height"}, {.name = "lid"}, {.name = "width", .correlations = {0.5, -0.25}}};
  EXPECT_EQ(shape_correlations(all),
            (Eigen::Matrix3d() << 1, 0, 0.5, 0, 1, -0.25, 0.5, -0.25, 1).finished());
}

TEST(ShapeCorrelations, AreRefusedIfNoDistributionHasThem) {
  const auto refusal = [](std::vector<double> correlations) {
    return ::testing::ThrowsMessage<DataError>(::testing::HasSubstr(
        correlations.size() == 1 ? "no distribution" : "'lid' has 2 correlations, expected 1"));
  };
  for (const std::vector<double>& bad :
       std::vector<std::vector<double>>{{1.5}, {1}, {std::nan("")}, {0.1, 0.2}})
    EXPECT_THAT(
        [&] {
          (void)shape_correlations(std::vector<ShapeParameter>{
              {.name = "height"}, {.name = "lid", .correlations = bad}});
        },
        refusal(bad));
}

TEST(ShapeTargets, RefuseWhatIsNotThere) {
  const Scene scene = two_hands();
  EXPECT_THAT([&] { ShapeTargets(scene, {"box"}, {}); },
              ::testing::ThrowsMessage<ConfigError>(
                  ::testing::HasSubstr("'box' is no model of this scene with shape parameters")));
  EXPECT_THAT([&] { ShapeTargets(scene, {}, {"indx"}); },
              ::testing::ThrowsMessage<ConfigError>(::testing::HasSubstr("did you mean 'index'?")));
  const Scene box({{"box", std::make_shared<Model>(test::make_test_box())}});
  EXPECT_THAT(
      [&] { ShapeTargets(box, {}, {}); },
      ::testing::ThrowsMessage<ConfigError>(::testing::HasSubstr("no model of this scene")));
}

}  // namespace
}  // namespace hypotrack
