#pragma once

#include "hypotrack/plugin/observation.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_patch {

/// Largest number of planes, whatever their distance.
inline constexpr int kMostPlanes = 256;
/// Largest number of values in a volume: large tiles get fewer planes.
inline constexpr int kMostNumbers = 1 << 26;

/// Returns planes around the scene as posed when the tiles were cut. They reach settings.range in
/// front of and behind it, settings.step pixels of the second view apart, or farther where views
/// are far apart. The distance is measured where pixels move fastest, among the tile's middle and
/// corners.
Planes planes_around(const Observation& observation, const Settings& settings);

}  // namespace hypotrack::stereo_patch
