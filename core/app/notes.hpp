#pragma once

#include "hypotrack/api/frame.hpp"
#include "hypotrack/plugin/source.hpp"
#include "track/loop/scene_tracker.hpp"

namespace hypotrack::app {

/// Prints notes on a scene that has no error but looks mistaken in its first usable frame.
void tell_notes(const Source& source, const SceneTracker& tracker, const Frame& first);

/// Prints what is wrong with the pictures or times of the first frames. `first` was read already;
/// the next ones are read from the source.
void tell_faults(Source& source, SceneTracker& tracker, const Frame& first);

}  // namespace hypotrack::app
