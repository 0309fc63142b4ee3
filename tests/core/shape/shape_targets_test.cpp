#include "shape/shape_targets.hpp"

#include <gmock/gmock.h>

#include "hypotrack/error.hpp"
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
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT(thin.row(axis).maxCoeff(), full.row(axis).maxCoeff() - 0.0005f) << axis;
    EXPECT_GT(thin.row(axis).minCoeff(), full.row(axis).minCoeff() + 0.0005f) << axis;
  }
  EXPECT_EQ(thinner->items()[2].model->data().landmarks[1].position,
            as_it_is->items()[2].model->data().landmarks[1].position);
  EXPECT_EQ(thinner->items()[0].model, scene.items()[0].model);
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
