#include "differential_evolution.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace {

class DifferentialEvolutionPlugin final : public hypotrack::DifferentialEvolution {
 public:
  using Params = hypotrack::DifferentialEvolutionParams;
  using DifferentialEvolution::DifferentialEvolution;
};

}  // namespace

HYPOTRACK_PLUGIN(DifferentialEvolutionPlugin,
                 "differential evolution (Storn and Price 1997) of pagmo", "batches seeded")
