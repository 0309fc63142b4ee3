#include "hand_model.hpp"

#include <gtest/gtest.h>

#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

std::shared_ptr<const Model> model(const std::string& yaml) {
  return PluginLoader().make<Model>(ConfigNode::parse(yaml, "test"), nullptr);
}

TEST(HandModel, TellsRightHandsFromLeftOnes) {
  EXPECT_TRUE(hand_model(*model("type: hand")).value().right);
  EXPECT_FALSE(hand_model(*model("{type: mirrored_hand, of: {type: hand}}")).value().right);
}

TEST(HandModel, IsNoneOfABoxOrOfAHandWithoutKnuckles) {
  EXPECT_FALSE(hand_model(*model("{type: rigid_box, size_mm: [60, 80, 100]}")).has_value());
  ModelData data = model("type: hand")->data();
  std::erase_if(data.landmarks, [](const Landmark& l) { return l.name.ends_with("_mcp"); });
  EXPECT_FALSE(hand_model(Model(data)).has_value());
}

TEST(HandModel, PutsLandmarksInTheModelsOrder) {
  ModelData data = model("type: hand")->data();
  std::ranges::reverse(data.landmarks);
  data.landmarks.push_back(data.landmarks.front());
  data.landmarks.back().name = "ring_on_a_finger";
  const std::optional<HandModel> hand = hand_model(Model(data));
  ASSERT_TRUE(hand);
  Eigen::Matrix<double, 3, 21> detected;
  for (Eigen::Index i = 0; i < 21; ++i) detected.col(i).setConstant(static_cast<double>(i));
  const Eigen::Matrix3Xd out = hand->in_model_order(detected, std::ssize(data.landmarks));
  for (std::size_t i = 0; i + 1 < data.landmarks.size(); ++i) {
    const auto name = std::ranges::find(kHandPointNames, data.landmarks[i].name);
    EXPECT_EQ(out(0, static_cast<Eigen::Index>(i)),
              static_cast<double>(name - kHandPointNames.begin()));
  }
  EXPECT_TRUE(std::isnan(out(0, out.cols() - 1)));
}

}  // namespace
}  // namespace hypotrack
