#include "hypotrack/plugin/plugin.hpp"

#include "collision_term.hpp"
#include "interpenetration.hpp"

namespace {

class Plugin final : public hypotrack::interpenetration::Interpenetration {
 public:
  using Params = hypotrack::interpenetration::InterpenetrationParams;
  Plugin(const Params& params, hypotrack::PluginContext& context)
      : Interpenetration(params, context.scene(), context.config().where()) {}
};

}  // namespace

HYPOTRACK_PLUGIN(Plugin, "keeps fingers, hands and objects from passing through each other",
                 hypotrack::interpenetration::capabilities())
