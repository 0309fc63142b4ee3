#pragma once

#include <vector>

#include "hypotrack/plugin/objective.hpp"
#include "params.hpp"

// The objective once more, in double precision, one pixel at a time and straight from the
// equations: what the fast paths are compared with.
namespace hypotrack::stereo_color::reference {

/// C of every pixel of a tile, row by row.
std::vector<double> weights(const TileView& view, const Params& params);

/// Cost of a hypothesis, colour space rgb or gray.
double cost(const Observation& observation, const RenderedHypothesis& hypothesis,
            const Params& params);

}  // namespace hypotrack::stereo_color::reference
