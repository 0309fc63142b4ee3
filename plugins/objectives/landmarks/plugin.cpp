#include "hypotrack/plugin/plugin.hpp"

#include "landmarks.hpp"

namespace {

class Plugin final : public hypotrack::landmarks::Landmarks {
 public:
  Plugin(const Params& params, hypotrack::PluginContext& context)
      : Landmarks(params, context.scene(), hypotrack::landmarks::networks(params, context.scene()),
                  context.log()) {}
};

}  // namespace

HYPOTRACK_PLUGIN(Plugin, "pulls hands to where a learned detector sees their landmarks",
                 "residuals jacobian")
