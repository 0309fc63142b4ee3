#include "hypotrack/gpu/skeleton.hpp"

#include <gtest/gtest.h>

#include <random>

#include "hypotrack/plugin/kinematics.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

Scene two_hands_a_box_and_a_cabinet() {
  const ModelData hand = test::make_test_hand();
  return Scene{{{"right", std::make_shared<Model>(hand)},
                {"box", std::make_shared<Model>(test::make_test_box())},
                {"left", std::make_shared<Model>(mirrored(hand))},
                {"cabinet", std::make_shared<Model>(test::make_test_cabinet())}}};
}

Eigen::Matrix<float, 3, 4> matrix(const Placement& placement) {
  return Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(placement.m);
}

TEST(Skeleton, PosesTheBonesOfAllModelsAsKinematicsDo) {
  const Scene scene = two_hands_a_box_and_a_cabinet();
  const Skeleton skeleton(scene);
  std::mt19937_64 random(11);
  std::vector<Placement> bones(skeleton.bones.size());
  for (int round = 0; round < 20; ++round) {
    const Eigen::VectorXd state = test::random_state(scene, random);
    pose_bones(skeleton.layout(), state.data(), OneThread{}, bones.data());
    auto bone = bones.begin();
    for (const Scene::Item& item : scene.items()) {
      for (const auto& expected : world_from_bones(item.model->data(), scene.part(item, state))) {
        const Eigen::Matrix<float, 3, 4> wanted = expected.matrix().topRows<3>().cast<float>();
        EXPECT_TRUE(matrix(*bone).isApprox(wanted, 2e-6f)) << item.name << "\n" << wanted;
        ++bone;
      }
    }
    EXPECT_EQ(bone, bones.end());
  }
}

TEST(Skeleton, SaysHowDeepBonesLie) {
  const Scene scene = two_hands_a_box_and_a_cabinet();
  const Skeleton skeleton(scene);
  const SkeletonLayout layout = skeleton.layout();
  EXPECT_EQ(layout.bone_count, 21 + 1 + 21 + 6);
  std::int32_t deepest = 0;
  for (std::int32_t b = 0; b < layout.bone_count; ++b) {
    const std::int32_t parent = layout.bones[b].parent;
    EXPECT_EQ(layout.level[b], parent < 0 ? 0 : layout.level[parent] + 1);
    deepest = std::max(deepest, layout.level[b]);
  }
  EXPECT_EQ(layout.levels, deepest + 1);
  EXPECT_EQ(layout.bones[21].parent, -1);
}

}  // namespace
}  // namespace hypotrack
