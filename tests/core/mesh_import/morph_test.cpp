// glTF: morph targets move the shape by the weights of the file.

#include <gmock/gmock.h>

#include "gltf_files.hpp"

namespace hypotrack::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

class MorphTargets : public GltfTest {
 protected:
  /// Writes a tetrahedron with two targets: one raises its top by 1, the other moves all by 2 in y.
  static GlbWriter morphed() {
    GlbWriter writer = tetrahedron([](GlbWriter&, Json&) {});
    const Floats3 top = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 1}}, all(4, {0, 2, 0});
    const int first = writer.add(top, "VEC3", kFloat), second = writer.add(all, "VEC3", kFloat);
    writer.json()["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", first}},
                                                              {{"POSITION", second}}};
    return writer;
  }
};

TEST_F(MorphTargets, MoveThePositionsByTheMeshsWeights) {
  GlbWriter writer = morphed();
  EXPECT_EQ(read(writer).mesh.vertices.row(2).maxCoeff(), 1);
  writer.json()["meshes"][0]["weights"] = {0.5, -0.25};
  const ImportedMesh imported = read(writer);
  EXPECT_NEAR(imported.mesh.vertices.row(2).maxCoeff(), 1.5f, 1e-6f);
  EXPECT_NEAR(imported.mesh.vertices.row(1).minCoeff(), -0.5f, 1e-6f);
  EXPECT_NEAR(imported.mesh.vertices.row(1).maxCoeff(), 0.5f, 1e-6f);
  EXPECT_THAT(imported.notes, Contains(HasSubstr("the shape is that of the file's weights")));
  EXPECT_THAT(imported.notes, Not(Contains(HasSubstr("base shape"))));
}

TEST_F(MorphTargets, HaveTheWeightsOfTheirNodeWhereItHasSome) {
  GlbWriter writer = morphed();
  Json& json = writer.json();
  json["meshes"][0]["weights"] = {1, 0};
  json["nodes"][0]["weights"] = {3, 0};
  EXPECT_NEAR(read(writer).mesh.vertices.row(2).maxCoeff(), 4, 1e-6f);
  json["nodes"].push_back({{"mesh", 0}, {"translation", {5, 0, 0}}});
  json["scenes"][0]["nodes"].push_back(1);
  const Mesh mesh = read(writer).mesh;
  float near = 0, far = 0;
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    float& highest = mesh.vertices(0, v) < 3 ? near : far;
    highest = std::max(highest, mesh.vertices(2, v));
  }
  EXPECT_NEAR(near, 4, 1e-6f);
  EXPECT_NEAR(far, 2, 1e-6f);
}

TEST_F(MorphTargets, OfAnotherSizeAreRefusedAndOfColoursNamed) {
  GlbWriter writer = morphed();
  Json& json = writer.json();
  json["meshes"][0]["weights"] = {1, 0};
  Json& target = json["meshes"][0]["primitives"][0]["targets"][0];
  target["COLOR_0"] = target["POSITION"];
  EXPECT_THAT(read(writer).notes, Contains(HasSubstr("not applied, of meshes: body (COLOR_0)")));
  const int three = writer.add(Floats3(3), "VEC3", kFloat);
  target["POSITION"] = three;
  EXPECT_THAT(error(writer), HasSubstr("mesh 'body': morph target 0 has 3 values for 4 vertices"));
  json["meshes"][0]["weights"] = {"1"};
  EXPECT_THAT(error(writer), HasSubstr("a value of 'weights' is no number"));
}

}  // namespace
}  // namespace hypotrack::test
