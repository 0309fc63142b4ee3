#include "hypotrack/plugin.hpp"
#include "nlopt_optimizer.hpp"

namespace {

class NloptPlugin final : public hypotrack::Nlopt {
 public:
  using Params = hypotrack::NloptParams;
  NloptPlugin(const Params& params, hypotrack::PluginContext& context)
      : Nlopt(params, context.config().where()) {}
};

}  // namespace

HYPOTRACK_PLUGIN(NloptPlugin,
                 "derivative-free algorithms of NLopt: SBPLX, CRS2_LM, DIRECT and others", "seeded")
