#include <algorithm>

#include "hand_detection.hpp"

namespace hypotrack::hands {
namespace {

bool same(const HandPoints& a, const HandPoints& b) {
  constexpr double kShare = 0.15;  // of the larger hand's size
  return (a - b).colwise().norm().mean() < kShare * std::max(size_of(a), size_of(b));
}

}  // namespace

void add_or_merge(std::vector<HandDetection>& hands, const HandDetection& hand) {
  for (HandDetection& other : hands) {
    if (!same(other.landmarks, hand.landmarks)) continue;
    if (hand.presence > other.presence) other = hand;
    return;
  }
  hands.push_back(hand);
}

}  // namespace hypotrack::hands
