#include "hypotrack/plugin/plugin.hpp"
#include "icp_pso.hpp"

namespace {

class IcpPsoPlugin final : public hypotrack::IcpPso {
 public:
  using Params = hypotrack::IcpPsoParams;
  IcpPsoPlugin(const Params& params, hypotrack::PluginContext& context)
      : IcpPso(params, context.make<hypotrack::Optimizer>(params.optimizer),
               context.config().where()) {}
};

}  // namespace

HYPOTRACK_PLUGIN(IcpPsoPlugin,
                 "particle swarm with local steps of every particle (after Qian et al. 2014), on "
                 "the scene's residuals instead of depth",
                 "batches seeded")
