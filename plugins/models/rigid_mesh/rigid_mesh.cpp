// A rigid object from a mesh file.

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hypotrack/api/mesh_io.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "hypotrack/plugin/shape.hpp"

namespace hypotrack {
namespace {

enum class Unit { m, cm, mm, inch };
[[maybe_unused]] std::span<const std::string_view> enum_names(Unit) {
  static constexpr std::array<std::string_view, 4> kNames = {"m", "cm", "mm", "inch"};
  return kNames;
}

enum class Origin { center, file };
[[maybe_unused]] std::span<const std::string_view> enum_names(Origin) {
  static constexpr std::array<std::string_view, 2> kNames = {"center", "file"};
  return kNames;
}

struct Anchor {
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();

  void visit(ParamVisitor& v) {
    v("name", name, {.help = "name of the landmark", .required = true});
    v("position_mm", position,
      {.help = "in the model's frame", .unit = "mm", .to_si = kMillimetre, .required = true});
  }
};

struct RigidMeshParams {
  std::filesystem::path mesh;
  Unit units = Unit::m;
  double scale = 1;
  std::filesystem::path texture;
  Origin origin = Origin::center;
  double simplify = 0.5e-3;
  std::vector<Anchor> anchors;
  ShapeSettings shape;

  void visit(ParamVisitor& v) {
    v("mesh", mesh,
      {.help = "DAE, OBJ, PLY, STL, glTF or GLB file; attached:NAME: a mesh that the program holds",
       .required = true});
    v("units", units, {.help = "unit of the file's coordinates"});
    v("scale", scale, {.help = "makes the object larger or smaller", .min = 1e-4, .max = 1e4});
    v("texture", texture, {.help = "image to use instead of the one that the mesh names"});
    v("origin", origin, {.help = "the model's origin: centre of its bounding box, or the file's"});
    v("simplify_mm", simplify,
      {.help = "distance from the mesh within which hypotheses are scored with fewer triangles; "
               "0: all",
       .min = 0,
       .max = 5,
       .unit = "mm",
       .to_si = kMillimetre});
    v("anchors", anchors, {.help = "points for the error; default: three of the bounding box"});
    shape.visit(v);
  }
};

double metres(Unit unit) {
  switch (unit) {
    case Unit::m:
      return 1;
    case Unit::cm:
      return 0.01;
    case Unit::mm:
      return kMillimetre;
    case Unit::inch:
      return 0.0254;
  }
  return 1;
}

/// `scale`: of the shape, by which the object is made larger or smaller afterwards.
ModelData make_object(const RigidMeshParams& params, const PluginContext& context, double scale) {
  ImportedMesh imported =
      import_mesh(context, params.mesh,
                  {.scale = params.scale * metres(params.units), .texture = params.texture});
  for (const std::string& note : imported.notes) context.log().note(note);
  Eigen::Matrix3Xf& vertices = imported.mesh.vertices;
  const Eigen::Vector3f low = vertices.rowwise().minCoeff();
  const Eigen::Vector3f high = vertices.rowwise().maxCoeff();
  const float size = (high - low).maxCoeff();
  if (size > 5 || size < 0.005f) {
    throw DataError(
        fmt::format("{}: the object is {:.3g} m long, which no hand holds; say its unit "
                    "with `units: mm` (or m, cm, inch), or change `scale`",
                    params.mesh.string(), size));
  }
  if (params.origin == Origin::center) vertices.colwise() -= (low + high) / 2;
  std::vector<Landmark> landmarks;
  for (const Anchor& anchor : params.anchors)
    landmarks.push_back({anchor.name, 0, anchor.position});
  ModelData data = rigid_model(std::move(imported.mesh), std::move(landmarks));
  const double error = simplify(data, params.simplify / scale);
  if (data.simplified.triangles.cols() > 0)
    context.log().note(fmt::format(
        "{}: hypotheses are scored with {} triangles for its {}, which are up to {:.2g} mm away "
        "(`simplify_mm`)",
        params.mesh.string(), data.simplified.triangles.cols(), data.mesh.triangles.cols(),
        scale * error / kMillimetre));
  return data;
}

/// Returns the shape parameters of an object: its scale only. Objects have no anthropometry, and a
/// file's scale may be wrong by a tenth.
const std::vector<ShapeParameter>& size_parameters() {
  static const std::vector<ShapeParameter> parameters = {{"scale", 1, 1, 0.5, 2, 0.1}};
  return parameters;
}

ModelData scaled(ModelData neutral, std::span<const double> values) {
  if (values.size() != 1) {
    throw Error(fmt::format("rigid_mesh: a shape has {} numbers, expected 1", values.size()));
  }
  if (values[0] != 1) scale_model(neutral, values[0]);
  return neutral;
}

class RigidMesh : public Model {
 public:
  using Params = RigidMeshParams;
  RigidMesh(const Params& params, PluginContext& context)
      : RigidMesh(params, context, read_shape(params.shape, size_parameters())) {}

 private:
  std::vector<ShapeParameter> do_shape_parameters() const override {
    std::vector<ShapeParameter> parameters = size_parameters();
    parameters[0].value = shape_[0];
    return parameters;
  }
  ModelData do_shaped(std::span<const double> values) const override {
    return scaled(neutral_, values);
  }

  RigidMesh(const Params& params, PluginContext& context, std::vector<double> shape)
      : RigidMesh(make_object(params, context, shape[0]), shape) {}

  RigidMesh(const ModelData& neutral, std::vector<double> shape)
      : Model(scaled(neutral, shape)), neutral_(neutral), shape_(std::move(shape)) {}

  ModelData neutral_;
  std::vector<double> shape_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::RigidMesh, "a rigid object from a mesh file", "")
