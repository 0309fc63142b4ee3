#pragma once

#include <memory>

#include "hypotrack/plugin/objective.hpp"

namespace hypotrack::test {

/// An objective over the pixels of every view that a hypothesis covers, on the CPU and on the
/// device: the sum of 1 + 0.002 x + 0.003 y + 0.25 / z.
std::shared_ptr<Objective> covered_probe();

/// An objective over the pixels of a stereo pair, in both directions: those seen weigh
/// 1 + 0.002 u + 0.001 column + 0.0015 row, those occluded 0.5. With `uncovered` those not covered
/// weigh 0.01.
std::shared_ptr<Objective> seen_probe(bool uncovered);

/// An objective that is the same only where the same pixels of every view are covered and have the
/// same depth, to the last bit; for tiles of up to 256 x 256 pixels.
std::shared_ptr<Objective> mark_probe();

/// An objective that counts the pixels of every view that are covered unlike their right neighbour.
/// On the device it only scores what is drawn.
std::shared_ptr<Objective> edge_probe();

}  // namespace hypotrack::test
