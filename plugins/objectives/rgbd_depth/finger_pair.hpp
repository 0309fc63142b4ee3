#pragma once

#include "hypotrack/pixel.hpp"

namespace hypotrack::rgbd_depth {

/// Where a state has the abductions of two fingers that are neighbours.
struct FingerPair {
  int first;   ///< of the finger on the thumb's side
  int second;  ///< of the one on the little finger's side
  bool operator==(const FingerPair&) const = default;
};

/// kc = sum over the pairs of -min(phi, 0), radians, with phi the difference of their abductions:
/// how far fingers have moved into their neighbours.
template <class Number>
HYPOTRACK_PIXEL double finger_crossing(const FingerPair* pairs, int count, const Number* state) {
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    const double phi =
        static_cast<double>(state[pairs[i].first]) - static_cast<double>(state[pairs[i].second]);
    sum += phi < 0 ? -phi : 0.0;
  }
  return sum;
}

}  // namespace hypotrack::rgbd_depth
