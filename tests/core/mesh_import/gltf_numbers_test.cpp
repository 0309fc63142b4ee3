// Numbers of glTF files are read by their type, wherever they lie.

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "gltf_files.hpp"

namespace hypotrack::test {
namespace {

using ::testing::HasSubstr;

class GltfNumbers : public GltfTest {};

/// Returns numbers from -1 or 0 to 1 as normalised whole numbers.
template <class Whole, std::size_t N>
std::vector<std::array<Whole, N>> normalized(const std::vector<std::array<float, N>>& values) {
  std::vector<std::array<Whole, N>> out(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t k = 0; k < N; ++k)
      out[i][k] = static_cast<Whole>(
          std::lround(values[i][k] * static_cast<float>(std::numeric_limits<Whole>::max())));
  return out;
}

/// Returns the vertex at a place, or -1.
Eigen::Index vertex_at(const Mesh& mesh, const Eigen::Vector3f& place) {
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v)
    if ((mesh.vertices.col(v) - place).norm() < 1e-4f) return v;
  return -1;
}

/// Returns the weight of a bone on the vertex at a place.
float weight_at(const ImportedMesh& imported, const Eigen::Vector3f& place, const char* bone) {
  const Mesh& mesh = imported.mesh;
  const Eigen::Index v = vertex_at(mesh, place);
  if (v < 0) return -1;
  float sum = 0;
  for (int k = 0; k < 4; ++k)
    if (imported.bones[static_cast<std::size_t>(mesh.bone_indices(k, v))].name == bone)
      sum += mesh.bone_weights(k, v);
  return sum;
}

using Floats4 = std::vector<std::array<float, 4>>;
const Floats4 kWeights = {{1, 0, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}, {0.25f, 0.75f, 0, 0}};

/// Adds joints and weights: the vertex at (0, 0, 1) is held by both bones, that at (0, 1, 0) by
/// `tip`.
template <class Joint, class Weights>
std::function<void(GlbWriter&, Json&)> add_influences(const Weights& weights, int joint_type,
                                                      int weight_type) {
  return [=](GlbWriter& writer, Json& attributes) {
    const std::vector<std::array<Joint, 4>> joints = {{0}, {0}, {1}, {0, 1}};
    attributes["JOINTS_0"] = writer.add(joints, "VEC4", joint_type);
    attributes["WEIGHTS_0"] = writer.add(weights, "VEC4", weight_type, weight_type != kFloat);
  };
}

TEST_F(GltfNumbers, WeightsOfBytesAndShortsAreNumbersFromZeroToOne) {
  for (const auto& add : {add_influences<std::uint8_t>(kWeights, kUnsignedByte, kFloat),
                          add_influences<std::uint8_t>(normalized<std::uint8_t>(kWeights),
                                                       kUnsignedByte, kUnsignedByte),
                          add_influences<std::uint16_t>(normalized<std::uint8_t>(kWeights),
                                                        kUnsignedShort, kUnsignedByte),
                          add_influences<std::uint8_t>(normalized<std::uint16_t>(kWeights),
                                                       kUnsignedByte, kUnsignedShort)}) {
    const ImportedMesh imported = read(skinned(add));
    ASSERT_EQ(imported.mesh.vertices.cols(), 4);
    EXPECT_EQ(weight_at(imported, {1, 0, 0}, "root"), 1);
    EXPECT_EQ(weight_at(imported, {0, 1, 0}, "tip"), 1);
    EXPECT_NEAR(weight_at(imported, {0, 0, 1}, "root"), 0.25f, 0.003f);
    EXPECT_NEAR(weight_at(imported, {0, 0, 1}, "tip"), 0.75f, 0.003f);
  }
}

TEST_F(GltfNumbers, TheFourStrongestOfEightInfluencesAreKept) {
  const auto add = [](GlbWriter& writer, Json& attributes) {
    const std::vector<std::array<std::uint8_t, 4>> joints(4, {0, 1, 2, 3}), more(4, {4, 5, 0, 0});
    attributes["JOINTS_0"] = writer.add(joints, "VEC4", kUnsignedByte);
    attributes["JOINTS_1"] = writer.add(more, "VEC4", kUnsignedByte);
    attributes["WEIGHTS_0"] = writer.add(Floats4(4, {0.1f, 0.05f, 0.2f, 0.05f}), "VEC4", kFloat);
    attributes["WEIGHTS_1"] = writer.add(Floats4(4, {0.2f, 0.4f, 0, 0}), "VEC4", kFloat);
  };
  GlbWriter writer = skinned(add);
  for (int i = 2; i < 6; ++i) {
    writer.json()["nodes"][1]["children"].push_back(i + 1);
    writer.json()["nodes"].push_back({{"name", "bone_" + std::to_string(i)}});
    writer.json()["skins"][0]["joints"].push_back(i + 1);
  }
  const ImportedMesh imported = read(writer);
  EXPECT_NEAR(weight_at(imported, {1, 0, 0}, "bone_5"), 0.4f / 0.9f, 1e-5f);
  EXPECT_NEAR(weight_at(imported, {1, 0, 0}, "bone_4"), 0.2f / 0.9f, 1e-5f);
  EXPECT_NEAR(weight_at(imported, {1, 0, 0}, "root"), 0.1f / 0.9f, 1e-5f);
  EXPECT_EQ(weight_at(imported, {1, 0, 0}, "tip"), 0);
}

TEST_F(GltfNumbers, TextureCoordinatesOfBytesAndShortsAreNumbersFromZeroToOne) {
  const std::vector<std::array<float, 2>> uvs = {{0, 0}, {1, 0}, {0, 1}, {0.2f, 0.6f}};
  file("t.ppm", "P6\n1 1\n255\nabc");
  const auto uv_of = [&](const auto& values, int type) {
    const GlbWriter writer = tetrahedron([&](GlbWriter& to, Json& attributes) {
      attributes["TEXCOORD_0"] = to.add(values, "VEC2", type, type != kFloat);
    });
    return Eigen::Matrix2Xf(read(writer, {.texture = folder_.path() / "t.ppm"}).mesh.uv);
  };
  const Eigen::Matrix2Xf floats = uv_of(uvs, kFloat);
  ASSERT_EQ(floats.cols(), 4);
  EXPECT_TRUE(uv_of(normalized<std::uint8_t>(uvs), kUnsignedByte).isApprox(floats, 1e-6f));
  EXPECT_TRUE(uv_of(normalized<std::uint16_t>(uvs), kUnsignedShort).isApprox(floats, 1e-4f));
}

TEST_F(GltfNumbers, TextureCoordinatesAreDrawnAsTheFloatsThatTheirNumbersAre) {
  const std::vector<std::array<float, 2>> uvs = {{0, 0}, {0.95f, 0}, {0, 0.95f}, {0.2f, 0.611f}};
  file("t.ppm", "P6\n1 1\n255\nabc");
  const auto uv_of = [&](const auto& values, int type) {
    const GlbWriter writer = tetrahedron([&](GlbWriter& to, Json& attributes) {
      attributes["TEXCOORD_0"] = to.add(values, "VEC2", type, type != kFloat);
    });
    return Eigen::Matrix2Xf(read(writer, {.texture = folder_.path() / "t.ppm"}).mesh.uv);
  };
  const auto expect_same = [&](const auto& whole, int type, double most) {
    auto floats = uvs;
    for (std::size_t i = 0; i < uvs.size(); ++i)
      for (std::size_t k = 0; k < 2; ++k) floats[i][k] = static_cast<float>(whole[i][k] / most);
    EXPECT_EQ(uv_of(whole, type), uv_of(floats, kFloat));
    EXPECT_NE(uv_of(whole, type), uv_of(uvs, kFloat));
  };
  expect_same(normalized<std::uint8_t>(uvs), kUnsignedByte, 255);
  expect_same(normalized<std::uint16_t>(uvs), kUnsignedShort, 65535);
}

TEST_F(GltfNumbers, ColorsOfBytesAndShortsAreNumbersFromZeroToOne) {
  const auto color_of = [&](const auto& values, int type) {
    return read(tetrahedron([&](GlbWriter& to, Json& attributes) {
             attributes["COLOR_0"] = to.add(values, "VEC3", type, type != kFloat);
           }))
        .mesh.color;
  };
  const Floats3 colors(4, {0.2f, 0.4f, 0.6f});
  const Eigen::Vector3f expected = color_of(colors, kFloat);
  // The numbers are linear in light; sRGB's curve makes a screen's colour of them.
  EXPECT_TRUE(expected.isApprox(Eigen::Vector3f(0.4845f, 0.6652f, 0.7977f), 0.01f));
  EXPECT_EQ(color_of(normalized<std::uint8_t>(colors), kUnsignedByte), expected);
  EXPECT_EQ(color_of(normalized<std::uint16_t>(colors), kUnsignedShort), expected);
}

TEST_F(GltfNumbers, QuantizedPositionsAreScaledByTheirNode) {
  const auto size_of = [&](const auto& corners, int type, bool normalized, double scale) {
    GlbWriter writer = tetrahedron([&](GlbWriter& to, Json& attributes) {
      attributes["POSITION"] = to.add(corners, "VEC3", type, normalized);
    });
    writer.json()["extensionsUsed"] = {"KHR_mesh_quantization"};
    writer.json()["extensionsRequired"] = {"KHR_mesh_quantization"};
    writer.json()["nodes"][0]["scale"] = {scale, scale, scale};
    writer.json()["nodes"][0]["translation"] = {1, 0, 0};
    const ImportedMesh imported = read(writer);
    EXPECT_TRUE(imported.notes.empty());
    EXPECT_GE(vertex_at(imported.mesh, {1, 0, 0}), 0);
    return vertex_at(imported.mesh, {1.5f, 0, 0}) >= 0 &&
           vertex_at(imported.mesh, {1, 0, 0.5f}) >= 0;
  };
  const std::vector<std::array<std::int8_t, 3>> bytes = {
      {0, 0, 0}, {100, 0, 0}, {0, 100, 0}, {0, 0, 100}};
  EXPECT_TRUE(size_of(bytes, kByte, false, 0.005));
  EXPECT_TRUE(size_of(bytes, kByte, true, 0.5 * 127 / 100));
  EXPECT_TRUE(size_of(
      std::vector<std::array<std::int16_t, 3>>{
          {0, 0, 0}, {20000, 0, 0}, {0, 20000, 0}, {0, 0, 20000}},
      kShort, true, 0.5 * 32767 / 20000));
  EXPECT_TRUE(size_of(
      std::vector<std::array<std::uint16_t, 3>>{
          {0, 0, 0}, {50000, 0, 0}, {0, 50000, 0}, {0, 0, 50000}},
      kUnsignedShort, false, 0.5 / 50000));
}

TEST_F(GltfNumbers, StridedValuesAreFound) {
  const GlbWriter writer = tetrahedron([](GlbWriter& to, Json& attributes) {
    const Floats4 padded = {{0, 0, 0, 9}, {1, 0, 0, 9}, {0, 1, 0, 9}, {0, 0, 1, 9}};
    attributes["POSITION"] = to.add(padded, "VEC3", kFloat);
    to.json()["bufferViews"][0]["byteStride"] = 16;
  });
  const Mesh mesh = read(writer).mesh;
  EXPECT_EQ(mesh.vertices.cols(), 4);
  for (const auto& [x, y, z] : corners()) EXPECT_GE(vertex_at(mesh, {x, y, z}), 0);
}

TEST_F(GltfNumbers, SparseValuesReplaceThoseOfTheirAccessor) {
  for (const bool has_view : {false, true}) {
    const GlbWriter writer = tetrahedron([&](GlbWriter& to, Json& attributes) {
      const std::vector<std::array<std::int8_t, 3>> base = {
          {0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      const std::vector<std::array<std::int8_t, 3>> replaced = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
      const std::vector<std::uint16_t> places = {1, 2, 3};
      attributes["POSITION"] = to.add(base, "VEC3", kByte);
      const int indices = to.add_view(places.data(), 6), values = to.add_view(replaced.data(), 9);
      Json& accessor = to.json()["accessors"][0];
      accessor["sparse"] = {
          {"count", 3},
          {"indices", {{"bufferView", indices}, {"componentType", kUnsignedShort}}},
          {"values", {{"bufferView", values}}}};
      if (!has_view) accessor.erase("bufferView");
    });
    const Mesh mesh = read(writer).mesh;
    EXPECT_EQ(mesh.vertices.cols(), 4);
    EXPECT_GE(vertex_at(mesh, {0, 2, 0}), 0);
    EXPECT_GE(vertex_at(mesh, {0, 0, 3}), 0);
  }
}

TEST_F(GltfNumbers, BuffersLieInTextOrInAFileWhoseNameIsEncoded) {
  const GlbWriter writer = tetrahedron([](GlbWriter&, Json&) {});
  Json json = writer.json();
  json["asset"]["version"] = "2.0";
  json["buffers"] = {{{"byteLength", writer.binary().size()}, {"uri", "my%20data.bin"}}};
  file("my data.bin", writer.binary());
  EXPECT_EQ(import_mesh(file("a.gltf", json.dump())).mesh.vertices.cols(), 4);
  // "AAAA" is three zero bytes: all points of the first mesh are one, which has no faces.
  json["buffers"][0] = {{"byteLength", 60},
                        {"uri", "data:application/octet-stream;base64," + std::string(80, 'A')}};
  EXPECT_THAT(import_error(file("b.gltf", json.dump())), HasSubstr("all its triangles are"));
  json["buffers"][0]["uri"] = "data:application/octet-stream;base64,A*AA";
  EXPECT_THAT(import_error(file("b.gltf", json.dump())), HasSubstr("buffer 0 is no base64 text"));
  json["buffers"][0]["uri"] = "none.bin";
  EXPECT_THAT(import_error(file("b.gltf", json.dump())),
              HasSubstr("buffer 0, the file 'none.bin', is missing or no file; copy it beside"));
}

TEST_F(GltfNumbers, ValuesThatAreNotThereAreNamed) {
  const auto error_of = [&](const Add& add) { return error(tetrahedron(add)); };
  const auto set = [](const char* key, const Json& value) {
    return [=](GlbWriter& to, Json& attributes) {
      attributes["POSITION"] = to.add(corners(), "VEC3", kFloat);
      to.json()["accessors"][0][key] = value;
    };
  };
  EXPECT_THAT(
      error_of(set("count", 5)),
      HasSubstr("mesh 'body': POSITION (accessor 0): its values reach beyond their buffer"));
  EXPECT_THAT(error_of(set("count", 1000000000)), HasSubstr("there are 1000000000: decimate"));
  EXPECT_THAT(error_of(set("count", -1)), HasSubstr("a value of 'count' is no whole number"));
  EXPECT_THAT(error_of(set("byteOffset", 4294967295u)), HasSubstr("reach beyond"));
  EXPECT_THAT(error_of(set("componentType", 5124)), HasSubstr("have the unknown type 5124"));
  EXPECT_THAT(error_of(set("type", "VEC2")), HasSubstr("its values have the type VEC2"));
  EXPECT_THAT(error_of(set("bufferView", 9)),
              HasSubstr("names item 9 of 'bufferViews', but there"));
  EXPECT_THAT(error_of([](GlbWriter& to, Json& attributes) {
                attributes["TEXCOORD_0"] =
                    to.add(std::vector<std::array<float, 2>>(3), "VEC2", kFloat);
              }),
              HasSubstr("mesh 'body': TEXCOORD_0 has 3 values for 4 vertices"));
}

}  // namespace
}  // namespace hypotrack::test
