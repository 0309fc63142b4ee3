#pragma once

#include "hypotrack/plugin/particle.hpp"
#include "hypotrack/plugin/start_points.hpp"

namespace hypotrack {

/// Parameters of `type: pso` and `type: pso_cuda`.
struct PsoParams {
  int particles = 64;
  int generations = 64;
  StartParams start;
  double cognitive = 2.8;
  double social = 1.3;
  LimbReset reset;
  void visit(ParamVisitor& v) {
    v("particles", particles,
      {.help = "particles of the swarm, evaluated as one batch", .min = 1, .max = 1 << 20});
    v("generations", generations,
      {.help = "generations, the initial one included, where the scene names no budget",
       .min = 1,
       .max = 1 << 20});
    start.visit(v);
    v("cognitive", cognitive,
      {.help = "c1, pull of a particle's own best; cognitive + social must be above 4",
       .min = 0,
       .max = 100});
    v("social", social, {.help = "c2, pull of the swarm's best", .min = 0, .max = 100});
    v("reset_every", reset.every,
      {.help = "after every so many generations, particles get a new sample of one limb (finger) "
               "about the swarm's best; 0: never",
       .min = 0,
       .max = 1 << 20});
    v("reset_share", reset.share,
      {.help = "share of the particles that reset_every applies to", .min = 0, .max = 1});
  }
};

}  // namespace hypotrack
