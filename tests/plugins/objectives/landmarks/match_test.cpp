// Which detection belongs to which model.
#include "match.hpp"

#include <gtest/gtest.h>

#include "hands_in_view.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack::landmarks {
namespace {

/// Returns a hand of some size that looks to a place.
SeenHand hand_at(double x, double right, double size = 0.2) {
  SeenHand out;
  for (Eigen::Index i = 0; i < out.directions.cols(); ++i) {
    const double angle = 0.3 * static_cast<double>(i);
    out.directions.col(i) =
        Eigen::Vector3d(x + size / 2 * std::cos(angle), size / 2 * std::sin(angle), 1).normalized();
  }
  out.distance = 0.5;
  out.right = right;
  return out;
}

WantedHand wanted_at(double x, bool right) { return {hand_at(x, 0).directions, right}; }

TEST(Match, GivesEveryModelTheNearestHandOfItsSide) {
  const std::vector<WantedHand> wanted{wanted_at(0, true), wanted_at(0.1, true),
                                       wanted_at(0, false)};
  const std::vector<SeenHand> seen{hand_at(0.11, 0.8), hand_at(0.01, 0.9), hand_at(0.12, 0.2)};
  const auto found = match(wanted, seen);
  ASSERT_TRUE(found[0] && found[1] && found[2]);
  EXPECT_EQ(found[0]->right, 0.9);
  EXPECT_EQ(found[1]->right, 0.8);
  EXPECT_EQ(found[2]->right, 0.2);
}

TEST(Match, GivesNoHandTwice) {
  const std::vector<WantedHand> wanted{wanted_at(0.1, true), wanted_at(0, true)};
  const std::vector<SeenHand> seen{hand_at(0.01, 0.8)};
  const auto found = match(wanted, seen);
  EXPECT_FALSE(found[0]);
  EXPECT_TRUE(found[1]);
}

TEST(Match, LeavesOutHandsFartherThanTheirSize) {
  const std::vector<WantedHand> wanted{wanted_at(0, true)};
  EXPECT_TRUE(match(wanted, std::vector{hand_at(0.15, 0.9)})[0]);
  EXPECT_FALSE(match(wanted, std::vector{hand_at(0.3, 0.9)})[0]);
}

TEST(Match, IsNothingWithoutDetections) {
  EXPECT_FALSE(match(std::vector{wanted_at(0, true)}, {})[0]);
}

TEST(HandsThatOverlap, HaveCentresNearerThanHalfTheLargerSize) {
  const auto at = [](double x, double size) { return hand_at(x, 1, size).directions; };
  EXPECT_TRUE(overlap(at(0, 0.2), at(0.08, 0.2)));
  EXPECT_FALSE(overlap(at(0, 0.2), at(0.15, 0.2)));
  EXPECT_TRUE(overlap(at(0, 0.1), at(0.08, 0.2)));
  EXPECT_TRUE(overlap(at(0, 0.2), at(0.08, 0.1)));
}

TEST(SameHand, IsOneNearlyAtTheSamePlace) {
  EXPECT_TRUE(same_hand(hand_at(0, 1), hand_at(0.02, 1)));
  EXPECT_FALSE(same_hand(hand_at(0, 1), hand_at(0.1, 1)));
}

TEST(HandSide, IsToldByHowFingersBend) {
  PluginLoader plugins;
  const auto side = [&](const std::string& type) {
    const auto model = plugins.make<Model>(ConfigNode::parse("type: " + type + "\n", "scene.yaml"));
    const auto hand = hand_model(*model);
    return hand ? hand->right ? "right" : "left" : "no hand";
  };
  EXPECT_EQ(side("hand"), std::string("right"));
  EXPECT_EQ(side("mirrored_hand"), std::string("left"));
  EXPECT_EQ(side("rigid_box"), std::string("no hand"));
}

}  // namespace
}  // namespace hypotrack::landmarks
