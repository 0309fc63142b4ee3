#include <gmock/gmock.h>

#include "hypotrack/api/mesh_io.hpp"
#include "mesh_files.hpp"

namespace hypotrack::test {
namespace {

/// The colour of a point of colored_ply()'s tetrahedron, linear in the point.
Eigen::Vector3f color_at(const Eigen::Vector3f& p) {
  const Eigen::Vector3f red(150, 100, 100), green(100, 150, 100), blue(100, 100, 150);
  const Eigen::Vector3f grey(120, 120, 120);
  return ((1 - p.sum()) * red + p.x() * green + p.y() * blue + p.z() * grey) / 255;
}

class MeshVertexColors : public ::testing::Test {
 protected:
  Mesh import(const char* name, std::string_view bytes) {
    return import_mesh(write_file(folder_.path() / name, bytes)).mesh;
  }
  TemporaryDirectory folder_;
};

TEST_F(MeshVertexColors, OfAPlyAreInterpolatedOverItsTriangles) {
  const Mesh mesh = import("a.ply", colored_ply());
  ASSERT_FALSE(mesh.texture.empty());
  ASSERT_EQ(mesh.uv_triangles.cols(), mesh.triangles.cols());
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (const Eigen::Vector3f& share :
         {Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(0, 1, 0), Eigen::Vector3f(0, 0, 1),
          Eigen::Vector3f(0, 0.5f, 0.5f), Eigen::Vector3f(0.25f, 0.5f, 0.25f)}) {
      const Eigen::Vector3f point = mesh.vertices(Eigen::all, mesh.triangles.col(t)) * share;
      const Eigen::Vector2f uv = mesh.uv(Eigen::all, mesh.uv_triangles.col(t)) * share;
      const Eigen::Vector3f found = look_up(mesh, uv), expected = color_at(point);
      EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 0.01f)
          << "triangle " << t << ": " << found.transpose() << ", not " << expected.transpose();
    }
  }
}

TEST_F(MeshVertexColors, OfAnObjAndAGlbAreReadToo) {
  const Mesh obj = import("a.obj",
                          "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 0 0 1 1 1 1\n"
                          "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  EXPECT_FALSE(obj.texture.empty());
  GlbContent content;
  content.colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  EXPECT_FALSE(import("a.glb", glb(content)).texture.empty());
}

TEST_F(MeshVertexColors, OfAnObjMayGoTo255) {
  const ImportedMesh imported = import_mesh(
      write_file(folder_.path() / "a.obj",
                 "v 0 0 0 51 102 204\nv 1 0 0 51 102 204\nv 0 1 0 51 102 204\nv 0 0 1 51 102 204\n"
                 "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"));
  EXPECT_TRUE(imported.mesh.color.isApprox(Eigen::Vector3f(0.2f, 0.4f, 0.8f), 1e-4f))
      << imported.mesh.color.transpose();
  EXPECT_THAT(imported.notes, testing::ElementsAre(testing::HasSubstr(
                                  "colours of vertices beyond 1: read as numbers from 0 to 255")));
}

TEST_F(MeshVertexColors, OfOneColorAreTheColorOfTheMesh) {
  GlbContent content;
  content.colors.assign(4, {1, 0.4f, 0});
  content.base_color = {0.5f, 0.5f, 0.5f, 1};
  const Mesh mesh = import("a.glb", glb(content));
  EXPECT_TRUE(mesh.texture.empty());
  EXPECT_EQ(mesh.uv.cols(), 0);
  // The products 0.5, 0.2 and 0 are linear in light; sRGB's curve makes a screen's colour of them.
  EXPECT_LT((mesh.color - Eigen::Vector3f(0.7354f, 0.4845f, 0)).cwiseAbs().maxCoeff(), 0.01f)
      << mesh.color.transpose();
}

}  // namespace
}  // namespace hypotrack::test
