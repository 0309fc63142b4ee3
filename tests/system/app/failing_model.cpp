// A plugin whose model breaks its contract at once, or where it is posed at a negative x.
#include <array>
#include <csignal>
#include <limits>
#include <stdexcept>

#include "hypotrack/plugin/plugin.hpp"

namespace {

enum class How {
  kNanMesh,
  kNoLandmarks,
  kSegfault,
  kException,
  kInt,
  kFewVertices,
  kManyVertices,
  kFewLandmarks,
  kNanVertex,
  kInfiniteVertex,
  kFarVertex,
  kNanLandmark,
};

std::span<const std::string_view> enum_names(How) {
  static constexpr std::array<std::string_view, 12> kNames = {
      "nan_mesh",   "no_landmarks",    "segfault",      "exception",
      "int",        "few_vertices",    "many_vertices", "few_landmarks",
      "nan_vertex", "infinite_vertex", "far_vertex",    "nan_landmark"};
  return kNames;
}

hypotrack::ModelData data_of(How how) {
  hypotrack::Mesh mesh;
  mesh.vertices = Eigen::Matrix3Xf::Identity(3, 3) * 0.1F;
  if (how == How::kNanMesh) mesh.vertices(0, 0) = std::numeric_limits<float>::quiet_NaN();
  mesh.triangles.resize(3, 1);  // GCC 14 warns of an assignment from Vector3i
  mesh.triangles << 0, 1, 2;
  hypotrack::ModelData data = hypotrack::rigid_model(mesh);
  if (how == How::kNoLandmarks) data.landmarks.clear();
  return data;
}

class Failing : public hypotrack::Model {
 public:
  struct Params {
    How how = How::kNanMesh;
    void visit(hypotrack::ParamVisitor& v) { v("how", how, {.help = "it fails"}); }
  };
  explicit Failing(const Params& params) : Model(data_of(params.how)), params_(params) {}

 private:
  bool do_poses_itself() const override { return true; }
  void do_pose(std::span<const double> parameters, Eigen::Matrix3Xf& vertices,
               Eigen::Matrix3Xd& landmarks) const override {
    Model::do_pose(parameters, vertices, landmarks);
    if (parameters[0] < -1e-4) fail(vertices, landmarks);
  }

  void fail(Eigen::Matrix3Xf& vertices, Eigen::Matrix3Xd& landmarks) const {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    if (params_.how == How::kSegfault) raise(SIGSEGV);
    if (params_.how == How::kException) throw std::runtime_error("the pose is broken");
    if (params_.how == How::kInt) throw 42;
    if (params_.how == How::kFewVertices) vertices.conservativeResize(3, 2);
    if (params_.how == How::kManyVertices) vertices.setZero(3, 1000);
    if (params_.how == How::kFewLandmarks) landmarks.resize(3, 0);
    if (params_.how == How::kNanVertex) vertices(2, 1) = kNan;
    if (params_.how == How::kInfiniteVertex)
      vertices(2, 1) = std::numeric_limits<float>::infinity();
    if (params_.how == How::kFarVertex) vertices(2, 1) = 1e30F;
    if (params_.how == How::kNanLandmark) landmarks(0, 0) = kNan;
  }

  Params params_;
};

}  // namespace

HYPOTRACK_PLUGIN(Failing, "fails when it is made or posed", "")
