// The left hand to any right hand: its mirror image in x = 0.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hypotrack/plugin/plugin.hpp"
#include "hypotrack/plugin/shape.hpp"

namespace hypotrack {
namespace {

struct MirroredHandParams {
  ConfigNode of = ConfigNode::parse("type: hand", "the default of mirrored_hand");
  ShapeSettings shape;
  void visit(ParamVisitor& v) {
    v("of", of, {.help = "the model to mirror"});
    shape.visit(v);
  }
};

/// The hand to mirror, and its shape parameters.
struct Original {
  std::unique_ptr<Model> model;
  std::vector<ShapeParameter> shape;
};

Original make_original(const MirroredHandParams& params, PluginContext& context) {
  Original original{context.make<Model>(params.of), {}};
  if (original.model->poses_itself()) {
    throw ConfigError(params.of.where() +
                      ": this model poses itself and has no skeleton to mirror; give a hand or "
                      "another model with a skeleton");
  }
  original.shape = original.model->shape_parameters();
  if (!params.shape.given()) return original;
  if (params.of.get("shape").defined() || params.of.get("shape_file").defined()) {
    throw ConfigError(context.config().where() +
                      ": both the mirrored hand and the one in `of` are given a shape; leave one "
                      "out");
  }
  const std::vector<double> values = read_shape(params.shape, original.shape);
  for (std::size_t i = 0; i < values.size(); ++i) original.shape[i].value = values[i];
  return original;
}

class MirroredHand : public Model {
 public:
  using Params = MirroredHandParams;
  MirroredHand(const Params& params, PluginContext& context)
      : MirroredHand(make_original(params, context)) {}

 private:
  std::vector<ShapeParameter> do_shape_parameters() const override { return original_.shape; }
  ModelData do_shaped(std::span<const double> values) const override {
    return mirrored(original_.model->shaped(values));
  }
  /// Returns the directions of the original, mirrored.
  std::vector<NamedDirection> do_directions() const override {
    std::vector<NamedDirection> all = original_.model->directions();
    for (NamedDirection& direction : all) direction.axis.x() *= -1;
    return all;
  }
  std::vector<std::string> do_clear_landmarks() const override {
    return original_.model->clear_landmarks();
  }

  explicit MirroredHand(Original original)
      : Model(mirror(original)), original_(std::move(original)) {}

  static ModelData mirror(const Original& original) {
    std::vector<double> values;
    for (const ShapeParameter& p : original.shape) values.push_back(p.value);
    return mirrored(original.model->shaped(values));
  }

  Original original_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::MirroredHand, "the mirror image of a hand: left for right", "")
