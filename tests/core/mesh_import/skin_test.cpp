#include <gmock/gmock.h>

#include "hypotrack/api/mesh_io.hpp"
#include "mesh_files.hpp"

namespace hypotrack::test {
namespace {

ImportedMesh import(const GlbContent& content) {
  TemporaryDirectory folder;
  return import_mesh(write_file(folder.path() / "a.glb", glb(content)));
}

TEST(ImportedSkin, HasBonesWithParentsAndBindPlaces) {
  const ImportedMesh imported = import({});
  ASSERT_EQ(imported.bones.size(), 2u);
  EXPECT_EQ(imported.bones[0].name, "root");
  EXPECT_EQ(imported.bones[0].parent, "");
  EXPECT_EQ(imported.bones[1].name, "tip");
  EXPECT_EQ(imported.bones[1].parent, "root");
  EXPECT_TRUE(imported.bones[1].file_from_bone.translation().isApprox(Eigen::Vector3d(0, 1, 0)));
}

TEST(ImportedSkin, VerticesWithoutFacesMoveNoOthers) {
  GlbContent content;
  content.positions.push_back(content.positions[0]);  // which no face uses
  content.joints.push_back({1});
  content.weights.push_back({1, 0, 0, 0});
  const ImportedMesh imported = import(content);
  const Mesh& mesh = imported.mesh;
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    if (!mesh.vertices.col(v).isZero()) continue;
    EXPECT_EQ(mesh.bone_weights(0, v), 1);
    EXPECT_EQ(imported.bones[static_cast<std::size_t>(mesh.bone_indices(0, v))].name, "root");
  }
}

TEST(ImportedSkin, BoneScaleDoesNotStayInTheBindTransform) {
  GlbContent content;
  content.bones[0].scale = {100, 100, 100};
  content.bones[1].translation = {0, 0.01f, 0};
  const ImportedMesh imported = import(content);
  for (const ImportedBone& bone : imported.bones) {
    EXPECT_TRUE(bone.file_from_bone.linear().isUnitary(1e-6)) << bone.name;
  }
  EXPECT_NEAR(imported.bones[1].file_from_bone.translation().y(), 1, 1e-5);
}

TEST(ImportedSkin, BonesWithoutVerticesAreKept) {
  GlbContent content;
  content.bones.push_back({"end", 1, {0, 0.5f, 0}});
  const ImportedMesh imported = import(content);
  ASSERT_EQ(imported.bones.size(), 3u);
  EXPECT_EQ(imported.bones[2].name, "end");
  EXPECT_TRUE(imported.bones[2].file_from_bone.translation().isApprox(Eigen::Vector3d(0, 1.5, 0)));
}

}  // namespace
}  // namespace hypotrack::test
