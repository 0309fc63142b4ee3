#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/particle.hpp"
#include "hypotrack/plugin/start_points.hpp"

namespace hypotrack {

struct IcpPsoParams {
  ConfigNode optimizer;
  int particles = 16;
  int generations = 4;
  int local_evaluations = 0;
  StartParams start;
  double cognitive = 2.8;
  double social = 1.3;
  void visit(ParamVisitor& v) {
    v("optimizer", optimizer,
      {.help =
           "search that refines each particle: {type: levenberg_marquardt} or another local one",
       .required = true});
    v("particles", particles, {.help = "particles of the swarm", .min = 1, .max = 1 << 20});
    v("generations", generations,
      {.help = "generations, the initial one included, where the scene names no budget",
       .min = 1,
       .max = 1 << 20});
    v("local_evaluations", local_evaluations,
      {.help = "evaluations of a particle in a generation; 0: enough for two Jacobians with three "
               "steps each",
       .min = 0,
       .max = 1 << 20});
    start.visit(v);
    v("cognitive", cognitive,
      {.help = "c1, pull of a particle's own best; cognitive + social must be above 4",
       .min = 0,
       .max = 100});
    v("social", social, {.help = "c2, pull of the swarm's best", .min = 0, .max = 100});
  }
};

/// Moves a swarm whose particles are refined between generations.
///
/// The idea is that of C. Qian, X. Sun, Y. Wei, X. Tang and J. Sun, "Realtime and robust hand
/// tracking from depth", CVPR 2014. In every generation each particle first makes local steps from
/// its position. Then the swarm moves (Clerc and Kennedy 2002, as in `pso`).
///
/// Unlike there, a step minimises the linearised residuals of the scene (by `optimizer`), not
/// distances between a depth image and the closest spheres of a hand. Their finger detection and
/// the particles that they start from it have no part here. The start and samples about it are the
/// first particles.
///
/// The refined position replaces the particle's; its velocity stays. The refinements of a
/// generation share batches where the optimizer can (Optimizer::minimize_each).
class IcpPso : public Optimizer {
 public:
  /// `where` is the place of the parameters in messages. Throws ConfigError unless cognitive +
  /// social > 4.
  IcpPso(const IcpPsoParams& params, std::unique_ptr<Optimizer> optimizer,
         const std::string& where = "icp_pso");

  Requirements requirements() const override { return optimizer_->requirements(); }
  std::int64_t default_evaluations() const override;
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  /// Returns the evaluations of a particle in a generation.
  std::int64_t local_evaluations(CostFunction& cost) const;

  IcpPsoParams params_;
  Constriction constriction_;
  std::unique_ptr<Optimizer> optimizer_;
};

}  // namespace hypotrack
