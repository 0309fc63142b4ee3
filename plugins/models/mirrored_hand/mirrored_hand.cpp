// The left hand to any right hand: its mirror image in x = 0.

#include <memory>

#include "hypotrack/plugin.hpp"

namespace hypotrack {
namespace {

class MirroredHand : public Model {
 public:
  struct Params {
    ConfigNode of = ConfigNode::parse("type: hand", "the default of mirrored_hand");
    void visit(ParamVisitor& v) { v("of", of, {.help = "the model to mirror"}); }
  };

  MirroredHand(const Params& params, PluginContext& context)
      : Model(mirror(*context.make<Model>(params.of), params.of)) {}

 private:
  static ModelData mirror(const Model& model, const ConfigNode& config) {
    if (model.poses_itself()) {
      throw ConfigError(config.where() +
                        ": this model poses itself and has no skeleton to mirror; give a hand or "
                        "another model with a skeleton");
    }
    return mirrored(model.data());
  }
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::MirroredHand, "the mirror image of a hand: left for right", "")
