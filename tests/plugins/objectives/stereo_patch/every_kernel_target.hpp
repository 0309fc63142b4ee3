#pragma once

#include "../../../support/every_target.hpp"
#include "score.hpp"
#include "volume_kernel.hpp"

namespace hypotrack::stereo_patch {

/// Runs `body` on every instruction set that all kernels of the objective are compiled for.
template <class Body>
void on_every_target(Body body) {
  test::on_every_target(score_targets() & volume_targets(), body);
}

}  // namespace hypotrack::stereo_patch
