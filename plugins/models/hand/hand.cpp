// A hand of 27 parameters from a skinned mesh and a rig (rig.hpp).

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hand_points.hpp"
#include "hand_shape.hpp"
#include "hypotrack/api/mesh_io.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "hypotrack/plugin/shape.hpp"
#include "palm.hpp"
#include "rig.hpp"

namespace hypotrack {
namespace {

struct HandParams {
  std::filesystem::path mesh;
  std::filesystem::path rig;
  double scale = 1;
  std::vector<double> finger_scale;
  ShapeSettings shape;
  std::filesystem::path texture;
  std::optional<double> cut;

  void visit(ParamVisitor& v) {
    v("mesh", mesh, {.help = "skinned hand, glTF or GLB; default: hypotrack's own"});
    v("rig", rig, {.help = "rig file of the mesh, or the name of a ready rig"});
    v("scale", scale, {.help = "makes the hand larger or smaller", .min = 0.1, .max = 10});
    v("finger_scale", finger_scale,
      {.help = "factor on the lengths of the fingers: one for all, or thumb, index, middle, ring, "
               "little",
       .min = 0.5,
       .max = 2});
    shape.visit(v);
    v("texture", texture, {.help = "image to use instead of the one that the mesh names"});
    v("cut_mm", cut,
      {.help = "cuts the arm off this far proximal of the wrist; default: the rig's",
       .min = -50,
       .max = 500,
       .unit = "mm",
       .to_si = kMillimetre});
  }
};

std::vector<std::string> ready_rigs() {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(data_file("rigs"), error)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Finds the rig: a file, or the name of an included rig, which has no suffix and is no file.
std::filesystem::path find_rig(const HandParams& params, const ConfigNode& config) {
  if (params.rig.empty()) {
    if (params.mesh.empty()) return data_file("rigs/hypotrack_hand.yaml");
    throw ConfigError(
        fmt::format("{}: `mesh` needs a `rig`, which says what its bones mean: a file, "
                    "or one of {}",
                    config.where(), fmt::join(ready_rigs(), ", ")));
  }
  if (std::filesystem::exists(params.rig)) return params.rig;
  if (!params.rig.has_extension()) {
    const std::string name = params.rig.filename().string();
    const auto ready = data_file("rigs") / (name + ".yaml");
    if (std::filesystem::exists(ready)) return ready;
    throw ConfigError(fmt::format("{}: there is no ready rig '{}' and no such file{}",
                                  config.where(), name, hint_about(name, ready_rigs())));
  }
  throw ConfigError(
      fmt::format("{}: the rig file {} does not exist", config.where(), params.rig.string()));
}

void check_size(const ModelData& data, const std::string& where) {
  const Eigen::Vector3f size =
      data.mesh.vertices.rowwise().maxCoeff() - data.mesh.vertices.rowwise().minCoeff();
  if (size.maxCoeff() < 0.05f || size.maxCoeff() > 1.5f) {
    throw DataError(
        fmt::format("{}: the hand is {:.3g} m long; `scale` must make metres of the "
                    "file's unit (0.001 for millimetres)",
                    where, size.maxCoeff()));
  }
}

ModelData neutral_hand(const HandParams& params, const PluginContext& context) {
  const ConfigNode& config = context.config();
  const std::filesystem::path rig_file = find_rig(params, config);
  Rig rig = read_rig(rig_file);
  rig.scale *= params.scale;
  for (RigLandmark& landmark : rig.landmarks) landmark.position *= params.scale;
  if (params.cut) rig.cut = params.cut;
  const std::filesystem::path mesh =
      params.mesh.empty() ? data_file("hands/hypotrack_hand.glb") : params.mesh;
  const std::string where = fmt::format("{} (for {})", rig_file.string(), mesh.filename().string());
  const ImportedMesh imported = import_mesh(mesh, {.scale = rig.scale, .texture = params.texture});
  for (const std::string& note : imported.notes) context.log().note(note);
  ModelData data = rig_hand(imported, rig, where);
  build(data, {.lengths = finger_lengths(params.finger_scale, config.where())});
  check_size(data, where);
  return data;
}

ModelData shaped_hand(ModelData neutral, std::span<const double> shape) {
  build(neutral, hand_shape(shape));
  return neutral;
}

class Hand : public Model {
 public:
  using Params = HandParams;
  Hand(const Params& params, PluginContext& context)
      : Hand(neutral_hand(params, context), read_shape(params.shape, hand_shape_parameters())) {}

 private:
  std::vector<ShapeParameter> do_shape_parameters() const override {
    std::vector<ShapeParameter> parameters = hand_shape_parameters();
    for (std::size_t i = 0; i < parameters.size(); ++i) parameters[i].value = shape_[i];
    return parameters;
  }
  ModelData do_shaped(std::span<const double> values) const override {
    return shaped_hand(neutral_, values);
  }
  std::vector<NamedDirection> do_directions() const override { return palm_directions(*this); }
  std::vector<std::string> do_clear_landmarks() const override { return clear_hand_landmarks(); }

  Hand(const ModelData& neutral, std::vector<double> shape)
      : Model(shaped_hand(neutral, shape)), neutral_(neutral), shape_(std::move(shape)) {}

  ModelData neutral_;
  std::vector<double> shape_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Hand, "a hand of 27 parameters from a skinned mesh and a rig", "")
