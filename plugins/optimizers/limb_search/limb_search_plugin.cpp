#include "hypotrack/plugin/plugin.hpp"
#include "limb_search.hpp"

namespace {

class LimbSearchPlugin final : public hypotrack::LimbSearch {
 public:
  using Params = hypotrack::LimbSearchParams;
  LimbSearchPlugin(const Params& params, hypotrack::PluginContext& context)
      : LimbSearch(params, context.make<hypotrack::Optimizer>(params.optimizer)) {}
};

}  // namespace

HYPOTRACK_PLUGIN(LimbSearchPlugin,
                 "looks for each limb, a finger say, all over its bounds while the rest stays",
                 "batches seeded")
