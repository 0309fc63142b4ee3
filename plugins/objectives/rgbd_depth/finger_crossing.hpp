#pragma once

#include <span>
#include <vector>

#include "hypotrack/scene.hpp"

namespace hypotrack::rgbd_depth {

/// Where a state has the abductions of two fingers that are neighbours.
struct FingerPair {
  int first;   ///< of the finger on the thumb's side
  int second;  ///< of the one on the little finger's side
};

/// The pairs index and middle, middle and ring, ring and little finger of every model with
/// parameters of the names index_abduction, middle_abduction, ring_abduction, little_abduction:
/// angles that grow towards the thumb, on a right hand and on its mirror image. The thumb has none.
std::vector<FingerPair> adjacent_fingers(const Scene& scene);

/// kc = sum over the pairs of -min(phi, 0), radians, with phi the difference of their abductions:
/// how far fingers have moved into their neighbours.
double finger_crossing(std::span<const FingerPair> pairs, std::span<const double> state);

}  // namespace hypotrack::rgbd_depth
