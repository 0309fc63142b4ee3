#include "hypotrack/plugin/plugin.hpp"
#include "multi_start.hpp"

namespace {

class MultiStartPlugin final : public hypotrack::MultiStart {
 public:
  using Params = hypotrack::MultiStartParams;
  MultiStartPlugin(const Params& params, hypotrack::PluginContext& context)
      : MultiStart(params, context.make<hypotrack::Optimizer>(params.optimizer),
                   context.config().where()) {}
};

}  // namespace

HYPOTRACK_PLUGIN(MultiStartPlugin,
                 "searches from the best of many samples about the start; the best answer is kept",
                 "batches seeded")
