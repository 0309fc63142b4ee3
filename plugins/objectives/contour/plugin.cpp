#include "hypotrack/plugin/plugin.hpp"

#include "contour.hpp"

namespace {

class Plugin final : public hypotrack::contour::Contour {
 public:
  Plugin(const Params& params, hypotrack::PluginContext& context)
      : Contour(params, context.scene(), context.log()) {}
};

}  // namespace

HYPOTRACK_PLUGIN(Plugin, "outlines of rigid models against the colours on both sides of them",
                 "residuals jacobian")
