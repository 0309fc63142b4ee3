#include "track/recover/postures.hpp"

#include <gtest/gtest.h>

#include "test_models.hpp"

namespace hypotrack {
namespace {

Eigen::VectorXd rest(const ModelData& model) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(model.parameters.size()));
  for (std::size_t i = 0; i < model.parameters.size(); ++i)
    out[static_cast<Eigen::Index>(i)] = model.parameters[i].rest;
  return out;
}

TEST(Postures, LieWithinTheBoundsOfTheModel) {
  const ModelData hand = test::make_test_hand();
  const Postures postures(hand);
  EXPECT_GT(postures.all().size(), 3U);
  for (const Eigen::VectorXd& posture : postures.all()) {
    ASSERT_EQ(posture.size() + 7, static_cast<Eigen::Index>(hand.parameters.size()));
    for (Eigen::Index i = 0; i < posture.size(); ++i) {
      const Parameter& p = hand.parameters[static_cast<std::size_t>(i + 7)];
      EXPECT_GE(posture[i], p.lower) << p.name;
      EXPECT_LE(posture[i], p.upper) << p.name;
    }
  }
}

TEST(Postures, OfARigidModelAreOneWithoutAngles) {
  const Postures postures(test::make_test_box());
  ASSERT_EQ(postures.all().size(), 1U);
  EXPECT_EQ(postures.all()[0].size(), 0);
}

TEST(Postures, EveryLimbMayBeStraightHalfOrBent) {
  const ModelData hand = test::make_test_hand();
  const Postures postures(hand);
  ASSERT_EQ(postures.limbs().size(), 5U);
  for (const Postures::Limb& limb : postures.limbs()) {
    ASSERT_EQ(limb.variants.size(), 3U);
    for (std::size_t i = 0; i < limb.parameters.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      EXPECT_LT(limb.variants[0][k], limb.variants[1][k]);
      EXPECT_LT(limb.variants[1][k], limb.variants[2][k]);
      EXPECT_LE(limb.variants[2][k],
                hand.parameters[static_cast<std::size_t>(limb.parameters[i])].upper);
    }
  }
}

TEST(Postures, RememberOnlyWhatIsNew) {
  const ModelData hand = test::make_test_hand();
  Postures postures(hand);
  const std::size_t before = postures.all().size();
  Eigen::VectorXd seen = rest(hand);
  postures.remember(seen);
  EXPECT_EQ(postures.all().size(), before + 1);
  seen[7] += 0.05;
  postures.remember(seen);
  EXPECT_EQ(postures.all().size(), before + 1);
  seen[7] += 1;
  postures.remember(seen);
  EXPECT_EQ(postures.all().size(), before + 2);
}

TEST(Postures, RememberNoMoreThanAFew) {
  const ModelData hand = test::make_test_hand();
  Postures postures(hand);
  const std::size_t before = postures.all().size();
  Eigen::VectorXd seen = rest(hand);
  for (int i = 0; i < 100; ++i) {
    seen[7] += 1;
    postures.remember(seen);
  }
  EXPECT_LE(postures.all().size(), before + 10);
  EXPECT_EQ(seen.tail(seen.size() - 7).size(), postures.all().back().size());
}

}  // namespace
}  // namespace hypotrack
