#pragma once

#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack::test {

/// Two rectified tiles, 120 mm apart, in which a hand about (0, 0, 0.5) is some 90 of 128 pixels
/// high. The images are black.
Observation rectified_pair(const Scene& scene, int size = 128);

/// Two tiles of cameras that converge by 25 degrees, of unequal focal lengths and sizes, the first
/// one `size` pixels wide.
Observation general_pair(const Scene& scene, int size = 128);

/// Two models of the kind that make_test_hand and make_test_box make.
Scene hand_scene();
Scene hand_and_box_scene();

}  // namespace hypotrack::test
