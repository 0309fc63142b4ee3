#pragma once

#include <vector>

#include "finger_pair.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack::rgbd_depth {

/// The pairs index and middle, middle and ring, ring and little finger of every model with
/// parameters of the names index_abduction, middle_abduction, ring_abduction, little_abduction:
/// angles that grow towards the thumb, on a right hand and on its mirror image. The thumb has none.
std::vector<FingerPair> adjacent_fingers(const Scene& scene);

}  // namespace hypotrack::rgbd_depth
