#include "hypotrack/plugin/plugin.hpp"

#include "motion_term.hpp"
#include "plausible_motion.hpp"

namespace {

class Plugin final : public hypotrack::plausible_motion::PlausibleMotion {
 public:
  Plugin(const Params& params, hypotrack::PluginContext& context)
      : PlausibleMotion(params, context.scene()) {}
};

}  // namespace

HYPOTRACK_PLUGIN(Plugin, "keeps joints from jumping, and fingers that nobody sees plausible",
                 hypotrack::plausible_motion::capabilities())
