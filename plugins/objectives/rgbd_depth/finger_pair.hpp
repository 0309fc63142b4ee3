#pragma once

#include <vector>

#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack {
class Scene;
}

namespace hypotrack::rgbd_depth {

/// Indices of the abductions of two adjacent fingers in a state.
struct FingerPair {
  int first;   ///< of the finger on the thumb's side
  int second;  ///< of the one on the little finger's side
  bool operator==(const FingerPair&) const = default;
};

/// Computes kc, how far fingers have moved into their neighbours: the sum over pairs of -min(phi,
/// 0), in radians. phi is the difference of the pair's abductions.
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

/// Returns the adjacent fingers of every model: index and middle, middle and ring, ring and little
/// finger. Finds them by the parameters index_abduction, middle_abduction, ring_abduction and
/// little_abduction. These angles grow towards the thumb, on a right hand and on its mirror image.
/// The thumb has no pair.
std::vector<FingerPair> adjacent_fingers(const Scene& scene);

}  // namespace hypotrack::rgbd_depth
