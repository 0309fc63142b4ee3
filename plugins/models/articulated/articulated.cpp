// An object of several links with joints between them: a URDF file, or a skinned mesh and a rig.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "description.hpp"
#include "hand_points.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "landmarks.hpp"
#include "object_rig.hpp"
#include "palm.hpp"
#include "surface.hpp"

namespace hypotrack {
namespace {

using namespace articulated;

struct ArticulatedParams {
  std::filesystem::path file, rig, texture;
  double scale = 1;
  std::vector<Anchor> anchors;
  void visit(ParamVisitor& v) {
    v("file", file, {.help = "URDF file, or a skinned glTF or GLB file", .required = true});
    v("rig", rig,
      {.help = "for a glTF or GLB file: YAML file of the moving bones and their motions"});
    v("texture", texture,
      {.help = "for a glTF or GLB file: image to use instead of the one that the mesh names"});
    v("scale", scale,
      {.help = "for a URDF file: factor on all its lengths", .min = 1e-6, .max = 1e6});
    v("anchors", anchors,
      {.help = "points for the error; wrist, index_mcp, little_mcp and middle_tip give a hand's "
               "directions; default: three per link that moves"});
  }
};

/// An object without landmarks, and the names of its links.
struct Object {
  Assembly assembly;
  std::vector<std::string> links;
};

Object from_urdf(const ArticulatedParams& params, const std::string& where, const PluginLog& log) {
  for (const auto* path : {&params.rig, &params.texture})
    if (!path->empty())
      throw ConfigError(fmt::format("{}: a URDF file takes no `rig` and no `texture`; leave {} out",
                                    where, path->string()));
  const std::string file = params.file.string();
  const Description description = read_urdf(params.file, params.scale);
  for (const std::string& note : description.notes) log.note(note);
  if (description.visuals.empty())
    throw DataError(file +
                    ": no link has a <visual>, so there is nothing to draw; collision geometry is "
                    "not used: copy it to <visual> elements");
  Object object{assemble(description.mechanism, file), description.mechanism.links};
  std::vector<Part> parts;
  for (const Visual& visual : description.visuals)
    parts.push_back({visual_mesh(visual, file, log), visual.link});
  object.assembly.data.mesh = join(parts, object.assembly, file);
  return object;
}

Object from_mesh(const ArticulatedParams& params, const std::string& where, const PluginLog& log) {
  if (params.rig.empty())
    throw ConfigError(
        fmt::format("{}: {} needs a `rig`, which says which of its bones move; or "
                    "give a URDF file, whose name ends with .urdf",
                    where, params.file.string()));
  if (params.scale != 1)
    throw ConfigError(fmt::format("{}: `scale` is for URDF files; write it into the rig {}", where,
                                  params.rig.string()));
  const ObjectRig rig = read_object_rig(params.rig);
  const ImportedMesh imported =
      import_mesh(params.file, {.scale = rig.scale, .texture = params.texture});
  for (const std::string& note : imported.notes) log.note(note);
  const std::string rig_name =
      fmt::format("{} (for {})", params.rig.string(), params.file.filename().string());
  Object object{rig_object(imported, rig, rig_name), {}};
  for (const ImportedBone& bone : imported.bones) object.links.push_back(bone.name);
  return object;
}

void check_size(const ModelData& data, const std::string& file) {
  const float size =
      (data.mesh.vertices.rowwise().maxCoeff() - data.mesh.vertices.rowwise().minCoeff())
          .maxCoeff();
  if (size >= 0.005f && size <= 10) return;
  throw DataError(
      fmt::format("{}: the object is {:.3g} m long, expected 0.005 to 10; for a mesh in "
                  "millimetres write scale=\"0.001 0.001 0.001\" in its <mesh> element, "
                  "or `scale: 0.001` in its rig; `scale` of the model is for all of a URDF file",
                  file, size));
}

ModelData make_object(const ArticulatedParams& params, const PluginContext& context) {
  const std::string where = context.config().where(), file = params.file.string();
  std::string type = params.file.extension().string();
  std::ranges::transform(type, type.begin(), [](unsigned char c) { return std::tolower(c); });
  const PluginLog log = context.log();
  Object object = type == ".urdf" ? from_urdf(params, where, log) : from_mesh(params, where, log);
  ModelData& data = object.assembly.data;
  data.landmarks = params.anchors.empty()
                       ? bounding_box_landmarks_of_bones(data)
                       : landmarks_of(params.anchors, object.links, object.assembly, file);
  validate(data, file);
  check_size(data, file);
  return std::move(data);
}

class Articulated : public Model {
 public:
  using Params = ArticulatedParams;
  Articulated(const Params& params, PluginContext& context) : Model(make_object(params, context)) {}

 private:
  /// Returns the directions of a robot's hand, if the anchors have the names of a hand's landmarks.
  std::vector<NamedDirection> do_directions() const override { return palm_directions(*this); }
  std::vector<std::string> do_clear_landmarks() const override {
    return palm_axes(*this) ? clear_hand_landmarks() : std::vector<std::string>();
  }
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Articulated,
                 "an object with joints from a URDF file, or from a skinned mesh and a rig", "")
