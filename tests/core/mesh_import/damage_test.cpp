#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "mesh_files.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class DamagedMesh : public ::testing::Test {
 protected:
  std::string error(const char* name, std::string_view bytes) {
    return import_error(write_file(folder_.path() / name, bytes));
  }
  bool reads(const char* name, std::string_view bytes) {
    return import_mesh(write_file(folder_.path() / name, bytes)).mesh.triangles.cols() == 1;
  }
  TemporaryDirectory folder_;
};

TEST_F(DamagedMesh, WithoutFacesSaysSo) {
  EXPECT_THAT(error("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1\nl 1 2\n"), HasSubstr("a.obj: "));
  GlbContent content;
  content.indices = {0, 0, 1, 2, 2, 2};
  EXPECT_THAT(error("a.glb", glb(content)),
              HasSubstr("the mesh has no faces: all its triangles are degenerate"));
}

TEST_F(DamagedMesh, PipesThatAMeshNamesAreNotWaitedFor) {
  ASSERT_EQ(::mkfifo((folder_.path() / "pipe").c_str(), 0600), 0);
  EXPECT_TRUE(reads("a.obj", "mtllib pipe\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  EXPECT_THAT(error("a.gltf", R"({"asset": {"version": "2.0"},
    "buffers": [{"byteLength": 36, "uri": "pipe"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0})"),
              HasSubstr("pipe"));
}

TEST_F(DamagedMesh, VertexFarOffIsNamed) {
  EXPECT_THAT(error("a.obj", "v 0 0 0\nv 3e38 0 0\nv 0 -3e38 0\nf 1 2 3\n"),
              AllOf(HasSubstr("a.obj: vertex 1 of mesh"),
                    HasSubstr("lies 3e+38 m from the origin; expected at most 1e+09 m")));
}

TEST_F(DamagedMesh, NanVertexIsNamed) {
  GlbContent content;
  content.positions[2][1] = kNan;
  EXPECT_THAT(error("a.glb", glb(content)),
              AllOf(HasSubstr("vertex 2 of mesh"), HasSubstr("every coordinate must be finite")));
  EXPECT_THAT(error("a.obj", "v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n"),
              HasSubstr("a.obj: the OBJ file is damaged: line 3: v 'nan' is no number: every "
                        "coordinate must be finite"));
}

TEST_F(DamagedMesh, WeightsThatAreNoneLeaveTheirVertexWithoutABone) {
  for (const float weight : {0.0f, -1.0f, kNan}) {
    GlbContent content;
    content.weights[1] = {weight, 0, 0, 0};
    EXPECT_THAT(error("a.glb", glb(content)), HasSubstr("no bone holds vertex 1 of mesh"));
  }
}

TEST_F(DamagedMesh, WeightsThatDoNotSumToOneAreRefused) {
  for (const float weight : {0.3f, -0.25f, -1e-30f, kNan, 2.0f}) {
    GlbContent content;
    content.weights[3] = {0.25f, weight, 0, 0};
    EXPECT_THAT(error("a.glb", glb(content)), HasSubstr("the weights of vertex 3 of mesh"));
  }
}

TEST_F(DamagedMesh, WeightsThatSumToAlmostNothingAreRefused) {
  for (const float weight : {3.57e-43f, 1e-4f}) {
    GlbContent content;
    content.weights[3] = {0, weight, 0, 0};
    EXPECT_THAT(error("a.glb", glb(content)), HasSubstr("the weights of vertex 3 of mesh"));
  }
}

TEST_F(DamagedMesh, JointOutOfRangeIsNoBone) {
  GlbContent content;
  content.joints[2] = {77, 0, 0, 0};
  EXPECT_THAT(error("a.glb", glb(content)), HasSubstr("no bone holds vertex 2 of mesh"));
}

TEST_F(DamagedMesh, VerticesAreNumberedAsInTheFileWhateverTrianglesUse) {
  GlbContent content;
  content.positions.insert(content.positions.begin(), 2, {0.1f, 0.1f, 0.1f});
  content.joints.insert(content.joints.begin(), 2, {0});
  content.weights.insert(content.weights.begin(), 2, {1, 0, 0, 0});
  std::ranges::reverse(content.indices);
  for (std::uint16_t& corner : content.indices) corner += 2;
  const Mesh mesh = import_mesh(write_file(folder_.path() / "a.glb", glb(content))).mesh;
  ASSERT_EQ(mesh.vertices.cols(), 4);
  for (Eigen::Index v = 0; v < 4; ++v)
    EXPECT_EQ(mesh.bone_weights.col(v).maxCoeff(), mesh.vertices(2, v) == 1 ? 0.75f : 1.0f);
  for (const std::size_t vertex : {2, 3, 4, 5}) {
    GlbContent damaged = content;
    damaged.weights[vertex] = {};
    EXPECT_THAT(error("a.glb", glb(damaged)),
                HasSubstr("no bone holds vertex " + std::to_string(vertex) + " of mesh"));
  }
}

TEST_F(DamagedMesh, IndexOutOfRangeIsNamed) {
  GlbContent content;
  content.indices[4] = 999;
  EXPECT_THAT(error("a.glb", glb(content)),
              HasSubstr("1 of its 4 triangles name vertices that are not there"));
  EXPECT_THAT(error("a.obj", obj() + "f 1 2 99\n"),
              HasSubstr("line 9: the face names vertex 99, but there are 4"));
}

TEST_F(DamagedMesh, AnObjThatIsDamagedIsRefusedWithItsLine) {
  const std::string start = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n";
  const auto of_face = [&](const std::string& end) { return error("a.obj", start + end); };
  EXPECT_THAT(of_face("f 1 2"), HasSubstr("line 6: the face has 2 corners, expected three"));
  EXPECT_THAT(of_face("f 1/1 2/1 3/"), HasSubstr("'3/' names no texture coordinate"));
  EXPECT_THAT(of_face("f 1//1 2//1 3//1x\n"), HasSubstr("'3//1x' names no normal"));
  EXPECT_THAT(of_face("f 1/1 2/1 3/999999999999\n"),
              HasSubstr("line 6: the face names texture coordinate 999999999999, but there are 1"));
  EXPECT_THAT(of_face("f 1 2 99999999999999999999\n"), HasSubstr("names no vertex"));
  EXPECT_THAT(of_face("f 1 2 -4\n"), HasSubstr("'-4' names no vertex"));
  EXPECT_THAT(of_face("vt nan 0\nf 1 2 3\n"), HasSubstr("line 6: vt 'nan' is no number"));
  EXPECT_THAT(of_face("v .1 0 0\nf 1 2 3\n"),
              HasSubstr("line 6: v '.1' has no digit before the dot; write 0.1"));
  EXPECT_THAT(of_face("f 1 2 3\nv 0 1"), HasSubstr("line 7: v has 2 numbers, expected 3"));
  EXPECT_THAT(of_face("f 1 2 3\nlod 2\n"), HasSubstr("line 7: `lod` is not read: delete the line"));
  EXPECT_THAT(error("a.obj", "\xEF\xBB\xBF" + start + "f 1 2 3\n"),
              HasSubstr("line 1: a byte order mark hides its `v`"));
  EXPECT_TRUE(reads("a.obj", "\xEF\xBB\xBF# of Windows\n" + start + "f 1 2 3\n"));
  EXPECT_TRUE(reads("a.obj", start + "# f 1\nf -3/-1/-1 2//1 \\\n 3/1 \r\n"));
}

TEST_F(DamagedMesh, AnStlOfTextThatIsCutIsRefusedWithItsLine) {
  const std::string facet =
      "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0.25\n"
      " endloop\nendfacet\n";
  const std::string whole = "solid made up\n" + facet + "endsolid made up\n";
  EXPECT_TRUE(reads("a.stl", whole));
  for (const char* cut : {"0.25", "vertex 0 1", "endfacet", "endsolid"}) {
    const auto problem = error("a.stl", whole.substr(0, whole.find(cut) + 2));
    EXPECT_THAT(problem, HasSubstr("a.stl: the STL file is damaged: line ")) << cut;
  }
  EXPECT_THAT(error("a.stl", std::string(whole).replace(whole.find("0.25"), 4, "1e999")),
              HasSubstr("line 6: vertex '1e999' is no number"));
}

TEST_F(DamagedMesh, TruncatedFilesAreToldFromTheirLength) {
  const std::string whole = glb({});
  EXPECT_THAT(error("a.glb", whole.substr(0, whole.size() - 40)),
              AllOf(HasSubstr("the GLB file is damaged"), HasSubstr("copy or export it again")));
  EXPECT_THAT(error("a.stl", binary_stl().substr(0, 200)),
              HasSubstr("its header says 4 triangles, which take 284 bytes; it has 200"));
  EXPECT_THAT(error("b.stl", binary_stl() + "more"),
              HasSubstr("its header says 4 triangles, which take 284 bytes; it has 288"));
  EXPECT_THAT(error("a.ply", ply().substr(0, ply().size() - 10)),
              HasSubstr("its header says 4 vertex, 4 face, which take 8 lines at least, and 7 "));
  const std::string header = binary_ply().substr(0, binary_ply().find("end_header") + 10);
  EXPECT_THAT(error("header.ply", header), HasSubstr("104 bytes at least, and 0 follow"));
  EXPECT_THAT(
      error("b.ply", binary_ply().substr(0, binary_ply().size() - 1)),
      HasSubstr("its header says 4 vertex, 4 face, which take 104 bytes at least, and 103 "));
}

TEST_F(DamagedMesh, BoneScaledUnevenlyIsRefused) {
  GlbContent content;
  content.bones[1].scale = {1, 2, 1};
  EXPECT_THAT(error("a.glb", glb(content)),
              HasSubstr("bone 'tip' is scaled unevenly or sheared at the bind pose"));
}

TEST_F(DamagedMesh, JsonThatWouldEndTheImportersStackIsAnErrorLikeAnyOther) {
  // The JSON parser of assimp 5.2.5 recurses.
  const std::string bytes = "{\"asset\":" + std::string(2'000'000, '[') + "}";
  EXPECT_THAT(error("a.gltf", bytes), HasSubstr("its JSON is nested deeper than 64 levels"));
}

TEST_F(DamagedMesh, NotJsonIsTheImportersOwnMessage) {
  EXPECT_THAT(error("a.gltf", "{ this is not JSON"), HasSubstr("the mesh could not be read: "));
}

}  // namespace
}  // namespace hypotrack::test
