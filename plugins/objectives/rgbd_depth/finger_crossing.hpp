#pragma once

#include <vector>

#include "finger_pair.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack::rgbd_depth {

/// Returns the adjacent fingers of every model: index and middle, middle and ring, ring and little
/// finger. Finds them by the parameters index_abduction, middle_abduction, ring_abduction and
/// little_abduction. These angles grow towards the thumb, on a right hand and on its mirror image.
/// The thumb has no pair.
std::vector<FingerPair> adjacent_fingers(const Scene& scene);

}  // namespace hypotrack::rgbd_depth
