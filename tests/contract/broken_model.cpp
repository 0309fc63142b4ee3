// A box with a lid that keeps its contract except for a fault, named by a parameter.
#include <array>
#include <atomic>

#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "hypotrack/plugin/shape.hpp"

namespace hypotrack {
namespace {

enum class Fault {
  none,
  millimetres,
  two_of_one_name,
  no_landmarks,
  dead_angle,
  never_the_same,
  ignores_position,
  ignores_rotation,
  moves_on_its_own,
  dead_shape,
  drops_triangles,
  impossible_correlations,
  skewed_directions,
  two_directions_of_one_name,
};
constexpr std::array<std::string_view, 14> kFaults = {"none",
                                                      "millimetres",
                                                      "two_of_one_name",
                                                      "no_landmarks",
                                                      "dead_angle",
                                                      "never_the_same",
                                                      "ignores_position",
                                                      "ignores_rotation",
                                                      "moves_on_its_own",
                                                      "dead_shape",
                                                      "drops_triangles",
                                                      "impossible_correlations",
                                                      "skewed_directions",
                                                      "two_directions_of_one_name"};
std::span<const std::string_view> enum_names(Fault) { return kFaults; }

Mesh tetrahedron(float size) {
  Mesh mesh;
  mesh.vertices = size * Eigen::Matrix3Xf{{0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  mesh.triangles = Eigen::Matrix3Xi{{0, 0, 0, 1}, {2, 1, 3, 2}, {1, 3, 2, 3}};
  mesh.bone_indices = Eigen::Matrix4Xi::Zero(4, 4);
  mesh.bone_indices(0, 3) = 1;
  mesh.bone_weights = Eigen::Matrix4Xf::Zero(4, 4);
  mesh.bone_weights.row(0).setOnes();
  return mesh;
}

ModelData make_data(Fault fault) {
  static std::atomic<int> made = 0;
  ModelData data;
  float size = fault == Fault::millimetres ? 100 : 0.1f;
  if (fault == Fault::never_the_same) size *= 1 + 0.01f * static_cast<float>(++made);
  data.mesh = tetrahedron(size);
  data.bones = {{.name = "base"}, {.name = "lid", .parent = 0}};
  data.parameters = pose_parameters();
  data.parameters.push_back(
      {.name = "opening", .kind = ParameterKind::angle, .lower = 0, .upper = 1, .rest = 0});
  data.motions = {{.bone = 1,
                   .parameter = 7,
                   .axis = Eigen::Vector3d::UnitX(),
                   .scale = fault == Fault::dead_angle ? 0.0 : 1.0}};
  data.landmarks = {{.name = "base"},
                    {.name = fault == Fault::two_of_one_name ? "base" : "lid", .bone = 1}};
  if (fault == Fault::no_landmarks) data.landmarks.clear();
  return data;
}

class Broken final : public Model {
 public:
  struct Params {
    Fault fault = Fault::none;
    bool poses_itself = false;
    void visit(ParamVisitor& v) {
      v("fault", fault, {.help = "what is wrong with it"});
      v("poses_itself", poses_itself, {.help = "do without the skeleton"});
    }
  };
  explicit Broken(const Params& params) : Model(make_data(params.fault)), params_(params) {}

 private:
  bool do_poses_itself() const override { return params_.poses_itself; }

  std::vector<ShapeParameter> do_shape_parameters() const override {
    std::vector<ShapeParameter> all{{.name = "size", .lower = 0.5, .upper = 2, .deviation = 0.1}};
    if (params_.fault == Fault::impossible_correlations) all[0].correlations = {0.5};
    return all;
  }
  std::vector<NamedDirection> do_directions() const override {
    std::vector<NamedDirection> all{{"lid", Eigen::Vector3d::UnitZ()},
                                    {"front", Eigen::Vector3d::UnitX()}};
    if (params_.fault == Fault::skewed_directions) all[1].axis = {0.8, 0, 0.6};
    if (params_.fault == Fault::two_directions_of_one_name) all[1].name = "lid";
    return all;
  }
  ModelData do_shaped(std::span<const double> values) const override {
    ModelData other = data();
    if (params_.fault != Fault::dead_shape) scale_model(other, values[0]);
    if (params_.fault == Fault::drops_triangles && values[0] != 1)
      other.mesh.triangles.conservativeResize(3, 3);
    return other;
  }

  void do_pose(std::span<const double> parameters, Eigen::Matrix3Xf& vertices,
               Eigen::Matrix3Xd& landmarks) const override {
    Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(
        parameters.data(), static_cast<Eigen::Index>(parameters.size()));
    if (params_.fault == Fault::ignores_position) values[0] = 0;
    if (params_.fault == Fault::ignores_rotation) values.segment<4>(3) << 1, 0, 0, 0;
    if (params_.fault == Fault::moves_on_its_own) values[0] += 1e-7 * (++calls_ % 7);
    const auto bones =
        world_from_bones(data(), {values.data(), static_cast<std::size_t>(values.size())});
    vertices.resize(3, 4);
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector3d p = data().mesh.vertices.col(i).cast<double>();
      vertices.col(i) = (bones[i == 3 ? 1 : 0] * p).cast<float>();
    }
    landmarks.resize(3, 2);
    for (int i = 0; i < 2; ++i) landmarks.col(i) = bones[i].translation();
  }

  Params params_;
  mutable std::atomic<int> calls_ = 0;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Broken, "breaks the contract as asked", "")
