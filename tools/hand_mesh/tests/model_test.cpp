#include <gmock/gmock.h>

#include <memory>
#include <random>
#include <vector>

#include "hand_shape.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "surface.hpp"
#include "the_hand.hpp"

namespace hypotrack::hand_mesh {
namespace {

std::unique_ptr<Model> default_hand() {
  PluginLoader plugins;
  return plugins.make<Model>(ConfigNode::parse("type: hand\n", "scene.yaml"));
}

TEST(HandModel, IsTheGeneratedHand) {
  const std::unique_ptr<Model> model = default_hand();
  const ModelData& data = model->data();
  EXPECT_EQ(model->dimension(), 27);
  EXPECT_EQ(data.bones.size(), 21u);
  EXPECT_EQ(data.landmarks.size(), 21u);
  EXPECT_EQ(data.mesh.vertices.cols(), kVertices);
  EXPECT_EQ(data.mesh.texture.cols, the_hand().texture.cols);
}

/// The rig has to find the zero pose and the axes that the generator had in mind.
TEST(HandModel, StandsAsTheGeneratorWouldInAnyPose) {
  const std::unique_ptr<Model> model = default_hand();
  const ModelData& data = model->data();
  std::mt19937 random(1);
  for (int round = 0; round < 20; ++round) {
    std::vector<double> state(27, 0.0);
    state[3] = 1;
    DigitAngles angles;
    for (int i = 0; i < 20; ++i) {
      const Parameter& p = data.parameters[7 + i];
      const double t = static_cast<double>(random()) / std::mt19937::max();
      angles[i / 4][i % 4] = state[7 + i] = p.lower + t * (p.upper - p.lower);
    }
    const auto expected = pose_skeleton(angles);
    const auto bones = world_from_bones(data, state);
    ASSERT_EQ(bones.size(), expected.size());
    for (size_t b = 0; b < bones.size(); ++b) {
      EXPECT_LT((bones[b].translation() - expected[b].translation() / 1000).norm(), 2e-6)
          << data.bones[b].name;
      EXPECT_LT((bones[b].linear() - expected[b].linear()).norm(), 1e-4) << data.bones[b].name;
    }
  }
}

TEST(HandModel, HasItsFingertipsOnTheSkin) {
  const std::unique_ptr<Model> model = default_hand();
  const ModelData& data = model->data();
  const auto bones = bind_transforms(data);
  const HandSurface surface;
  int tips = 0;
  for (const Landmark& landmark : data.landmarks) {
    if (!landmark.name.ends_with("_tip")) continue;
    ++tips;
    EXPECT_NEAR(surface(1000 * (bones[landmark.bone] * landmark.position)), 0, 1.0)
        << landmark.name << ", millimetres";
  }
  EXPECT_EQ(tips, 5);
}

}  // namespace
}  // namespace hypotrack::hand_mesh
