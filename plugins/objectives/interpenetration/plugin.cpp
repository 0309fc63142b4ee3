#include "hypotrack/plugin/plugin.hpp"

#include "interpenetration.hpp"
#include "on_device.hpp"

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
