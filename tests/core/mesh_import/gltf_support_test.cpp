// glTF: what a file requires is read or refused, and what is left out is named.

#include <gmock/gmock.h>

#include "gltf_files.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

class GltfSupport : public GltfTest {
 protected:
  static GlbWriter plain() {
    return tetrahedron([](GlbWriter&, Json&) {});
  }
  static GlbWriter held(const std::vector<std::array<std::uint8_t, 4>>& joints) {
    return skinned([&](GlbWriter& to, Json& attributes) {
      const std::vector<std::array<float, 4>> weights(4, {1, 0, 0, 0});
      attributes["JOINTS_0"] = to.add(joints, "VEC4", kUnsignedByte);
      attributes["WEIGHTS_0"] = to.add(weights, "VEC4", kFloat);
    });
  }
};

TEST_F(GltfSupport, RequiredExtensionsThatAreNotReadAreNamedWithTheWayOut) {
  GlbWriter writer = plain();
  const auto error_of = [&](const char* name) {
    writer.json()["extensionsUsed"] = {"KHR_materials_unlit", name};
    writer.json()["extensionsRequired"] = {"KHR_materials_unlit", name};
    return error(writer);
  };
  EXPECT_THAT(error_of("VENDOR_of_2030"),
              HasSubstr("it requires the glTF extension VENDOR_of_2030, which hypotrack does not "
                        "read; export it again without it"));
  EXPECT_THAT(error_of("EXT_meshopt_compression"),
              AllOf(HasSubstr("requires the glTF extension EXT_meshopt_compression"),
                    HasSubstr("without -c")));
  EXPECT_THAT(error_of("KHR_texture_basisu"), HasSubstr("with PNG or JPEG textures"));
}

TEST_F(GltfSupport, OptionalExtensionsThatAreNotHonouredAreNamed) {
  GlbWriter writer = plain();
  writer.json()["extensionsUsed"] = {"KHR_materials_unlit", "VENDOR_of_2030", "KHR_materials_ior",
                                     "EXT_meshopt_compression", "EXT_odd"};
  EXPECT_THAT(read(writer).notes, ElementsAre(EndsWith("a.glb: glTF extensions that are not "
                                                       "honoured: VENDOR_of_2030, "
                                                       "EXT_odd")));
}

TEST_F(GltfSupport, KeysAndExtensionsOfAllObjectsAreNamed) {
  GlbWriter writer = plain();
  Json& json = writer.json();
  json["nodes"][0]["odd"] = json["nodes"][0]["extras"] = 1;
  json["nodes"][0]["extensions"]["VENDOR_unlisted"] = Json::object();
  json["meshes"][0]["primitives"][0]["odd"] = 1;
  json["accessors"][0]["odder"] = 1;
  json["materials"] = {{{"shine", 1}, {"pbrMetallicRoughness", {{"glow", 1}}}}};
  EXPECT_THAT(
      read(writer).notes,
      ElementsAre(EndsWith("glTF extensions that are not honoured: VENDOR_unlisted"),
                  EndsWith("keys that are not read: accessors.odder, materials.shine, nodes.odd, "
                           "pbrMetallicRoughness.glow, primitives.odd")));
}

TEST_F(GltfSupport, WhatIsLeftOutIsCounted) {
  GlbWriter writer = plain();
  Json& json = writer.json();
  json["animations"] = {{{"channels", Json::array()}, {"samplers", Json::array()}}};
  json["cameras"] = {{{"type", "perspective"}}, {{"type", "perspective"}}};
  json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  Json& primitives = json["meshes"][0]["primitives"];
  primitives[0]["attributes"]["COLOR_1"] = primitives[0]["attributes"]["_OWN"] = 0;
  primitives[0]["targets"] = {{{"POSITION", 0}}};
  primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
  json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"mode", 0}}}}});
  json["nodes"].push_back({{"mesh", 1}, {"camera", 0}});
  json["scenes"][0]["nodes"].push_back(1);
  json["scenes"].push_back({{"nodes", {0}}});
  json["odd"] = 7;
  const auto path = file("a.glb", writer.finish("MINE"));
  const ImportedMesh imported = import_mesh(path);
  EXPECT_EQ(imported.mesh.triangles.cols(), 4);
  const std::string begin = path.string() + ": ";
  EXPECT_THAT(
      imported.notes,
      ElementsAre(begin + "left out: 1 animation, 2 cameras, 1 light, 1 morph target (the "
                          "base shape is read), 2 sets of points or lines, 1 further scene",
                  begin + "attributes of vertices that are not read: COLOR_1",
                  begin + "keys that are not read: odd", begin + "chunks that are not read: MINE"));
}

TEST_F(GltfSupport, MeshesOfOtherScenesAreNotDrawn) {
  GlbWriter writer = plain();
  Json& json = writer.json();
  json["meshes"].push_back(json["meshes"][0]);
  json["nodes"].push_back({{"mesh", 1}, {"translation", {5, 0, 0}}});
  json["scenes"].push_back({{"nodes", {1}}});
  EXPECT_EQ(read(writer).mesh.vertices.maxCoeff(), 1);
  json["scene"] = 1;
  EXPECT_EQ(read(writer).mesh.vertices.maxCoeff(), 6);
}

TEST_F(GltfSupport, FilesWithoutScenesAreReadWhole) {
  GlbWriter writer = plain();
  writer.json().erase("scenes");
  EXPECT_EQ(read(writer).mesh.triangles.cols(), 4);
}

/// Returns the bytes of a text of hexadecimal digits.
std::string from_hex(std::string_view digits) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
    bytes += static_cast<char>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16));
  return bytes;
}

TEST_F(GltfSupport, MeshesThatDracoCompressedAreUnpacked) {
  // The tetrahedron of the other tests, as a mesh of Draco 2.2 with 14 bits per coordinate.
  const std::string draco = from_hex(
      "445241434f0202010000000404010001020002030003010201030101000903000002000101000303012001200300"
      "208450220100000000ff3f00000000000000000000000000000000803f0e");
  GlbWriter writer = plain();
  Json& json = writer.json();
  Json& primitive = json["meshes"][0]["primitives"][0];
  primitive["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", writer.add_view(draco.data(), draco.size())},
      {"attributes", {{"POSITION", 0}}}};
  for (Json& accessor : json["accessors"]) accessor.erase("bufferView");
  json["extensionsUsed"] = json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const ImportedMesh imported = read(writer);
  EXPECT_EQ(imported.mesh.triangles.cols(), 4);
  EXPECT_TRUE(imported.mesh.vertices.rowwise().maxCoeff().isOnes(1e-4f));
  EXPECT_TRUE(imported.notes.empty());
  json["accessors"][0]["componentType"] = kShort;
  EXPECT_THAT(error(writer),
              HasSubstr("mesh 'body': it has numbers that are compressed with "
                        "KHR_draco_mesh_compression and are no floats; export it again without"));
}

TEST_F(GltfSupport, SkinsWithoutBindMatricesHoldTheirMeshAtTheOrigin) {
  const ImportedMesh imported = read(held({{0}, {0}, {1}, {1}}));
  ASSERT_EQ(imported.bones.size(), 2u);
  EXPECT_EQ(imported.bones[1].name, "tip");
  EXPECT_EQ(imported.bones[1].parent, "root");
  for (const ImportedBone& bone : imported.bones)
    EXPECT_TRUE(bone.file_from_bone.matrix().isIdentity(1e-6)) << bone.name;
}

TEST_F(GltfSupport, BonesOfOneNameAreToldApart) {
  GlbWriter writer = held({{0}, {0}, {1}, {1}});
  Json& nodes = writer.json()["nodes"];
  nodes[0]["name"] = nodes[1]["name"] = nodes[2]["name"] = "bone";
  const ImportedMesh imported = read(writer);
  ASSERT_EQ(imported.bones.size(), 2u);
  EXPECT_EQ(imported.bones[0].name, "bone");
  EXPECT_EQ(imported.bones[1].name, "bone_3");
  EXPECT_EQ(imported.bones[1].parent, "bone");
  EXPECT_THAT(imported.notes, ElementsAre(EndsWith("a.glb: several bones have one name; the later "
                                                   "ones are read as bone_3")));
}

TEST_F(GltfSupport, QuantizedSkinsAwayFromTheirBindPoseKeepTheirSize) {
  const std::vector<std::array<std::int16_t, 3>> points = {
      {0, 0, 0}, {1000, 0, 0}, {0, 1000, 0}, {0, 0, 1000}};
  GlbWriter writer = skinned([&](GlbWriter& to, Json& attributes) {
    const std::vector<std::array<std::uint8_t, 4>> joints(4, {0});
    const std::vector<std::array<float, 4>> weights(4, {1, 0, 0, 0});
    attributes["POSITION"] = to.add(points, "VEC3", kShort);
    attributes["JOINTS_0"] = to.add(joints, "VEC4", kUnsignedByte);
    attributes["WEIGHTS_0"] = to.add(weights, "VEC4", kFloat);
  });
  std::array<float, 16> matrix{};  // of both bones: millimetres to metres
  matrix[0] = matrix[5] = matrix[10] = 0.001f;
  matrix[15] = 1;
  writer.json()["skins"][0]["inverseBindMatrices"] =
      writer.add(std::vector<std::array<float, 16>>(2, matrix), "MAT4", kFloat);
  for (const bool away : {false, true}) {
    if (away) writer.json()["nodes"][2]["translation"] = {0, 1, 0};
    const ImportedMesh imported = read(writer);
    EXPECT_TRUE(imported.mesh.vertices.rowwise().maxCoeff().isOnes(1e-4f)) << away;
    EXPECT_TRUE(imported.bones[1].file_from_bone.translation().isZero(1e-6)) << away;
    EXPECT_EQ(imported.notes.size(), away ? 1U : 0U) << "tells that the pose is not read";
  }
}

TEST_F(GltfSupport, AMeshThatASkinAndANodeShareIsReadForEach) {
  GlbWriter writer = held({{0}, {0}, {1}, {1}});
  Json& json = writer.json();
  json["nodes"].push_back({{"name", "copy"}, {"mesh", 0}, {"translation", {5, 0, 0}}});
  json["scenes"][0]["nodes"].push_back(3);
  // No bone holds the copy, which is an error; before, it stood where the skin is.
  EXPECT_THAT(error(writer), HasSubstr("no bone holds vertex 0 of mesh 'body'"));
}

TEST_F(GltfSupport, MeshesWithoutWeightsMoveWithTheBoneAboveThem) {
  GlbWriter writer = skinned([](GlbWriter& to, Json& attributes) {
    const std::vector<std::array<std::uint8_t, 4>> bones(4);
    const std::vector<std::array<float, 4>> ones(4, {1, 0, 0, 0});
    attributes["JOINTS_0"] = to.add(bones, "VEC4", kUnsignedByte);
    attributes["WEIGHTS_0"] = to.add(ones, "VEC4", kFloat);
  });
  Json& json = writer.json();
  Json rigid = json["meshes"][0]["primitives"][0];
  for (const char* key : {"JOINTS_0", "WEIGHTS_0"}) rigid["attributes"].erase(key);
  json["meshes"].push_back({{"name", "ring"}, {"primitives", {rigid}}});
  json["nodes"].push_back({{"name", "ring"}, {"mesh", 1}, {"translation", {0, 0, 0.5}}});
  json["scenes"][0]["nodes"].push_back(3);
  EXPECT_THAT(error(writer), AllOf(HasSubstr("no bone holds vertex 0 of mesh 'ring'"),
                                   HasSubstr("the mesh has no weights, though the file has bones: "
                                             "give it the weight 1 of one bone, or take it out")));

  // Below a bone it moves with the bone, wherever the file poses that.
  json["scenes"][0]["nodes"].erase(2);
  json["nodes"][2]["children"] = {3};
  const std::array<float, 16> root = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::array<float, 16> tip = root;
  tip[13] = -1;  // its bind place is 1 along y
  json["skins"][0]["inverseBindMatrices"] = writer.add(std::vector{root, tip}, "MAT4", kFloat);
  for (const double y : {1.0, 3.0}) {
    json["nodes"][2]["translation"] = {0, y, 0};
    const ImportedMesh imported = read(writer);
    ASSERT_EQ(imported.mesh.vertices.cols(), 8);
    EXPECT_TRUE(imported.mesh.vertices.col(4).isApprox(Eigen::Vector3f(0, 1, 0.5f))) << y;
    EXPECT_EQ(imported.mesh.bone_weights(0, 4), 1);
    const auto bone = static_cast<std::size_t>(imported.mesh.bone_indices(0, 4));
    EXPECT_EQ(imported.bones[bone].name, "tip");
  }
}

TEST_F(GltfSupport, OtherVersionsAndDeepJsonAreRefused) {
  EXPECT_THAT(import_error(file("a.gltf", R"({"asset": {"version": "1.0"}, "meshes": {}})")),
              HasSubstr("this is glTF version '1.0'; hypotrack reads version 2"));
  EXPECT_THAT(import_error(file("a.gltf", R"({"asset": {"version": "2.0", "minVersion": "2.1"}})")),
              HasSubstr("it needs a reader of glTF version '2.1'; hypotrack reads 2.0"));
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  EXPECT_THAT(
      import_error(file("a.gltf", R"({"asset": {"version": "2.0"}, "extras": )" + deep + "}")),
      HasSubstr("its JSON is nested deeper than 64 levels"));
  EXPECT_THAT(import_error(file("a.gltf", R"({"asset": )")), HasSubstr("JSON is damaged at byte"));
}

}  // namespace
}  // namespace hypotrack::test
