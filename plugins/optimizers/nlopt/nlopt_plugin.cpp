#include "hypotrack/plugin/plugin.hpp"
#include "nlopt_optimizer.hpp"

namespace {

class NloptPlugin final : public hypotrack::Nlopt {
 public:
  using Params = hypotrack::NloptParams;
  NloptPlugin(const Params& params, hypotrack::PluginContext& context)
      : Nlopt(params, context.config().where()) {}
};

}  // namespace

HYPOTRACK_PLUGIN(NloptPlugin, "algorithms of NLopt: SBPLX, LBFGS, CRS2_LM, DIRECT and others",
                 "seeded")
