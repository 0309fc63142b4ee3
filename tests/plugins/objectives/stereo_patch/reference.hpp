#pragma once

#include "hypotrack/plugin/objective.hpp"
#include "settings.hpp"

// The objective once more, in double precision, one pixel and one patch at a time and straight from
// the equations: what the fast paths are compared with.
namespace hypotrack::stereo_patch::reference {

double cost(const Observation& observation, const RenderedHypothesis& hypothesis,
            const Settings& settings);

}  // namespace hypotrack::stereo_patch::reference
