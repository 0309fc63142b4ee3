#include "hand_detection.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>

namespace hypotrack::hands {
namespace {

using Weights = Eigen::Matrix<double, 21, 21>;

/// A landmark that moves by a share of the vector between two landmarks.
struct Shift {
  Eigen::Index landmark, from, to;
  double share;
};
// Rounded from medians over rendered hands in any rotation, of the built-in mesh and godot_xr.
// Indices are those of kHandPointNames.
constexpr std::array<Shift, 8> kShifts = {{{0, 9, 0, 0.1},      // wrist, away from the fingers
                                           {1, 5, 17, 0.25},    // base of the thumb, to the palm
                                           {3, 2, 3, 0.1},      // thumb_ip, outwards
                                           {4, 3, 4, 0.25},     // tips, outwards
                                           {8, 7, 8, 0.25},     //
                                           {12, 11, 12, 0.25},  //
                                           {16, 15, 16, 0.25},  //
                                           {20, 19, 20, 0.25}}};

/// Returns the matrix that gives the joints when landmarks are multiplied by it.
const Weights& joints_from_landmarks() {
  static const Weights weights = [] {
    Weights out = Weights::Identity();
    for (const Shift& shift : kShifts) {
      out(shift.to, shift.landmark) += shift.share;
      out(shift.from, shift.landmark) -= shift.share;
    }
    return out;
  }();
  return weights;
}

bool same(const HandPoints& a, const HandPoints& b) {
  constexpr double kShare = 0.15;  // of the larger hand's size
  return (a - b).colwise().norm().mean() < kShare * std::max(size_of(a), size_of(b));
}

}  // namespace

HandPoints joints_of(const HandPoints& landmarks) { return landmarks * joints_from_landmarks(); }

HandPoints3D joints_of(const HandPoints3D& landmarks) {
  return landmarks * joints_from_landmarks();
}

HandPoints landmarks_at(const HandPoints& joints) {
  static const Weights inverse = joints_from_landmarks().inverse();
  return joints * inverse;
}

void add_or_merge(std::vector<HandDetection>& hands, const HandDetection& hand) {
  for (HandDetection& other : hands) {
    if (!same(other.landmarks, hand.landmarks)) continue;
    if (hand.presence > other.presence) other = hand;
    return;
  }
  hands.push_back(hand);
}

}  // namespace hypotrack::hands
