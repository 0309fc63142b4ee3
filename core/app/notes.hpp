#pragma once

#include "hypotrack/frame.hpp"
#include "hypotrack/source.hpp"
#include "track/tracker.hpp"

namespace hypotrack::app {

/// Points out what looks like a mistake in a scene, seen from its first usable frame, and is no
/// error.
void tell_notes(const Source& source, const Tracker& tracker, const Frame& first);

}  // namespace hypotrack::app
