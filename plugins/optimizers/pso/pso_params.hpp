#pragma once

#include "hypotrack/params.hpp"

namespace hypotrack {

/// Parameters of `type: pso` and `type: pso_cuda`.
struct PsoParams {
  int particles = 64;
  int generations = 64;
  double sigma = 0.5;
  double cognitive = 2.8;
  double social = 1.3;
  void visit(ParamVisitor& v) {
    v("particles", particles,
      {.help = "particles of the swarm, evaluated as one batch", .min = 1, .max = 1 << 20});
    v("generations", generations,
      {.help = "generations, the initial one included, where the scene names no budget",
       .min = 1,
       .max = 1 << 20});
    v("sigma", sigma,
      {.help = "standard deviation of the initial particles, as a share of the search region's "
               "spread",
       .min = 0,
       .max = 10});
    v("cognitive", cognitive,
      {.help = "c1, pull of a particle's own best; cognitive + social must be above 4",
       .min = 0,
       .max = 100});
    v("social", social, {.help = "c2, pull of the swarm's best", .min = 0, .max = 100});
  }
};

}  // namespace hypotrack
