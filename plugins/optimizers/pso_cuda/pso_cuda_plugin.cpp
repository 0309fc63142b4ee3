#include "hypotrack/plugin/plugin.hpp"
#include "pso_cuda.hpp"

namespace {

class PsoCudaPlugin final : public hypotrack::PsoCuda {
 public:
  using Params = hypotrack::PsoParams;
  PsoCudaPlugin(const Params& params, hypotrack::PluginContext& context)
      : PsoCuda(params, context.config().where()) {}
};

}  // namespace

HYPOTRACK_PLUGIN(PsoCudaPlugin, "the search of pso on the GPU, for scenes evaluated there",
                 "batches seeded needs_device")
