#include "hypotrack/plugin.hpp"
#include "pso.hpp"

namespace {

class PsoPlugin final : public hypotrack::Pso {
 public:
  using Params = hypotrack::PsoParams;
  PsoPlugin(const Params& params, hypotrack::PluginContext& context)
      : Pso(params, context.config().where()) {}
};

}  // namespace

HYPOTRACK_PLUGIN(PsoPlugin,
                 "particle swarm with constriction (Clerc and Kennedy 2002), the paper's optimizer",
                 "batches seeded")
