#pragma once

#include "../../../support/every_target.hpp"
#include "score.hpp"

namespace hypotrack::stereo_color {

/// Runs a body once per instruction set that this machine has and the objective is compiled for.
template <class Body>
void on_every_target(Body body) {
  test::on_every_target(compiled_targets(), body);
}

}  // namespace hypotrack::stereo_color
