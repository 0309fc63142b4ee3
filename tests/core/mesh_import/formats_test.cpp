#include <gmock/gmock.h>

#include <filesystem>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/mesh_io.hpp"
#include "mesh_files.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class MeshFormats : public ::testing::Test {
 protected:
  std::filesystem::path file(const char* name, std::string_view bytes) {
    return write_file(folder_.path() / name, bytes);
  }
  TemporaryDirectory folder_;
};

double volume(const Mesh& mesh) {
  double sum = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Matrix3f corners = mesh.vertices(Eigen::all, mesh.triangles.col(t));
    sum += static_cast<double>(corners.determinant()) / 6;
  }
  return sum;
}

TEST_F(MeshFormats, EveryFormatGivesTheSameWeldedTetrahedronWithItsOutsideOut) {
  for (const auto& path :
       {file("a.obj", obj()), file("a.STL", binary_stl()), file("a.glb", glb({})),
        file("a.ply", ply()), file("b.ply", binary_ply())}) {
    const ImportedMesh imported = import_mesh(path);
    EXPECT_EQ(imported.mesh.vertices.cols(), 4) << path;
    EXPECT_EQ(imported.mesh.triangles.cols(), 4) << path;
    EXPECT_NEAR(volume(imported.mesh), 1.0 / 6, 1e-6) << path;
  }
}

TEST_F(MeshFormats, ScaleMakesMetresOfVerticesAndBones) {
  const ImportedMesh imported = import_mesh(file("a.glb", glb({})), {.scale = 0.01});
  EXPECT_NEAR(imported.mesh.vertices.maxCoeff(), 0.01, 1e-7);
  EXPECT_TRUE(
      imported.bones[1].file_from_bone.translation().isApprox(Eigen::Vector3d(0, 0.01, 0), 1e-6));
  EXPECT_THROW(import_mesh(file("b.glb", glb({})), {.scale = 0}), DataError);
}

TEST_F(MeshFormats, RigidFilesHaveNoBonesAndNoWeights) {
  const ImportedMesh imported = import_mesh(file("a.obj", obj()));
  EXPECT_TRUE(imported.bones.empty());
  EXPECT_EQ(imported.mesh.bone_weights.cols(), 0);
}

TEST_F(MeshFormats, OtherFormatsAreRefusedByNameWithTheListOfThoseThatAreRead) {
  for (const char* name : {"a.fbx", "a.x3d", "a.zae", "a.3ds", "a.mesh", "a"}) {
    const std::filesystem::path path(name);
    EXPECT_THAT(import_error(file(name, "ply\n")),
                AllOf(HasSubstr(name), HasSubstr("does not read meshes of type"),
                      HasSubstr("OBJ, PLY, STL, glTF (.gltf) and GLB")));
  }
}

TEST_F(MeshFormats, ContentThatBeliesTheNameIsRefused) {
  EXPECT_THAT(import_error(file("a.glb", obj() + obj())), HasSubstr("this is no GLB file"));
  EXPECT_THAT(import_error(file("a.gltf", glb({}))), HasSubstr("this is no glTF file"));
  EXPECT_THAT(import_error(file("a.obj", glb({}))), HasSubstr("this is no OBJ file"));
  EXPECT_THAT(import_error(file("b.obj", "ply\nformat ascii 1.0\n")),
              HasSubstr("this is no OBJ file: it begins with 'ply'"));
  EXPECT_THAT(import_error(file("a.ply", obj())),
              HasSubstr("this is no PLY file: it does not begin with 'ply'"));
  EXPECT_THAT(import_error(file("b.ply", "ply\nformat ascii 1.0\n")),
              HasSubstr("this is no PLY file: its header does not end"));
  EXPECT_THAT(import_error(file("c.ply", "ply\nelement vertex 0\nend_header\n")),
              HasSubstr("this is no PLY file: its header has no line 'format'"));
  for (const char* line : {"format text 1.0", "format ascii 2.0", "element vertex -3",
                           "element vertex", "property float x", "hello"}) {
    EXPECT_THAT(import_error(file("d.ply", std::string("ply\n") + line + "\nend_header\n")),
                HasSubstr(std::string("its header has the line '") + line + "'"));
  }
  EXPECT_THAT(import_error(file("a.stl", "hello")), HasSubstr("this is no STL file"));
}

TEST_F(MeshFormats, MissingEmptyAndHugeFilesAreNamed) {
  EXPECT_THAT(import_error(folder_.path() / "none.obj"), HasSubstr("there is no such mesh file"));
  EXPECT_THAT(import_error(file("a.obj", "")), HasSubstr("the mesh file is empty"));
  const auto huge = file("huge.obj", obj());
  std::filesystem::resize_file(huge, std::uintmax_t{300} << 20);  // sparse
  EXPECT_THAT(import_error(huge), HasSubstr("has 300 MiB; at most 256 MiB are read"));
  std::filesystem::create_directory(folder_.path() / "folder.obj");
  EXPECT_THAT(import_error(folder_.path() / "folder.obj"), HasSubstr("the mesh is not a file"));
}

}  // namespace
}  // namespace hypotrack::test
