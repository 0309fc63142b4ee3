// A plugin whose mesh has a vertex that is no point.
#include <limits>

#include "hypotrack/plugin.hpp"

namespace {

class Failing : public hypotrack::Model {
 public:
  struct Params {
    void visit(hypotrack::ParamVisitor&) {}
  };
  explicit Failing(const Params&) : Model(hypotrack::rigid_model(mesh())) {}

 private:
  static hypotrack::Mesh mesh() {
    hypotrack::Mesh mesh;
    mesh.vertices = Eigen::Matrix3Xf::Identity(3, 3);
    mesh.vertices(0, 0) = std::numeric_limits<float>::quiet_NaN();
    mesh.triangles = Eigen::Vector3i(0, 1, 2);
    return mesh;
  }
};

}  // namespace

HYPOTRACK_PLUGIN(Failing, "has a mesh with a hole in its numbers", "")
