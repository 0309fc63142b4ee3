#pragma once

#include "hypotrack/plugin/objective.hpp"
#include "params.hpp"

// The objective once more, in double precision, over every pixel of the tiles and straight from the
// equations: what the fast path is compared with.
namespace hypotrack::rgbd_depth::reference {

/// D + lambda S of a hypothesis; the foreground is the mask.
double cost(const Observation& observation, const RenderedHypothesis& hypothesis,
            const Params& params);

}  // namespace hypotrack::rgbd_depth::reference
