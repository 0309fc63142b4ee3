#pragma once

#include "hypotrack/observation.hpp"
#include "planes_layout.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_patch {

/// No more planes than this, however far apart they come to lie.
inline constexpr int kMostPlanes = 256;
/// No more numbers than this in a volume: large tiles get fewer planes.
inline constexpr int kMostNumbers = 1 << 26;

/// The planes around the scene posed as the tiles were cut: settings.range before and behind it,
/// settings.step pixels of the second view apart (there where the pixels move fastest of the tile's
/// middle and corners).
Planes planes_around(const Observation& observation, const Settings& settings);

}  // namespace hypotrack::stereo_patch
