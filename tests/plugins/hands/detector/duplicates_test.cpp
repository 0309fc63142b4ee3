#include <gtest/gtest.h>

#include <cmath>

#include "hand_detection.hpp"

namespace hypotrack::hands {
namespace {

/// A hand of about `size` pixels at `x`.
HandDetection hand_at(double x, double size, double presence) {
  HandDetection out;
  for (int i = 0; i < 21; ++i) {
    out.landmarks.col(i) << x + size / 2 * std::sin(i), size / 2 * std::cos(i);
  }
  out.presence = presence;
  return out;
}

TEST(Duplicates, OfAHandAreReplacedByTheSurest) {
  std::vector<HandDetection> hands;
  add_or_merge(hands, hand_at(100, 80, 0.7));
  add_or_merge(hands, hand_at(104, 82, 0.9));
  add_or_merge(hands, hand_at(102, 80, 0.8));
  ASSERT_EQ(hands.size(), 1u);
  EXPECT_EQ(hands[0].presence, 0.9);
}

TEST(Duplicates, AreNotHandsBesideEachOther) {
  std::vector<HandDetection> hands;
  add_or_merge(hands, hand_at(100, 80, 0.7));
  add_or_merge(hands, hand_at(140, 80, 0.9));
  add_or_merge(hands, hand_at(100, 20, 0.9));
  EXPECT_EQ(hands.size(), 3u);
}

}  // namespace
}  // namespace hypotrack::hands
