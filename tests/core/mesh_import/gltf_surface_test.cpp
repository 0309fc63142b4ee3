// Colours of glTF surfaces: what the tracker compares with its pictures. Expected numbers are those
// of glTF 2.0 and its extensions, worked out by hand.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "hypotrack/api/media.hpp"
#include "hypotrack/api/mesh_io.hpp"
#include "mesh_files.hpp"

namespace hypotrack::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Json = nlohmann::json;

/// A square from (0, 0, 0) to (1, 1, 0), written as a .gltf file with its data beside it. Its
/// picture is red and green above, blue and yellow below.
class GltfSurface : public testing::Test {
 protected:
  using Corners = std::vector<std::array<float, 2>>;

  GltfSurface() {
    cv::Mat3b picture(8, 8);
    picture({0, 0, 4, 4}).setTo(cv::Scalar(10, 10, 249));
    picture({4, 0, 4, 4}).setTo(cv::Scalar(10, 249, 10));
    picture({0, 4, 4, 4}).setTo(cv::Scalar(249, 10, 10));
    picture({4, 4, 4, 4}).setTo(cv::Scalar(10, 249, 249));
    write_picture("four.png", picture);
    json_["asset"]["version"] = "2.0";
    json_["images"] = {{{"uri", "four.png"}}};
    json_["textures"] = {{{"source", 0}, {"sampler", 0}}};
    json_["samplers"] = Json::array({Json::object()});
    json_["scenes"] = {{{"nodes", {0}}}};
    json_["nodes"] = {{{"mesh", 0}}};
    json_["materials"] = {{{"name", "label"}}};
    surface()["baseColorTexture"]["index"] = 0;
    attributes_["POSITION"] =
        add({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");  // corners against the clock
  }

  void write_picture(const char* name, const cv::Mat& picture) {
    const std::vector<unsigned char> bytes = encode_image(".png", picture);
    write_file(folder_.path() / name, std::string(bytes.begin(), bytes.end()));
  }

  /// Puts a picture of one colour into the buffer.
  Json picture_inside(const char* type, const cv::Vec3b& bgr) {
    const std::vector<unsigned char> bytes = encode_image(type, cv::Mat3b(4, 4, bgr));
    json_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", bytes.size()}});
    data_.append(bytes.begin(), bytes.end());
    data_.resize((data_.size() + 3) / 4 * 4);
    return {{"bufferView", json_["bufferViews"].size() - 1},
            {"mimeType", "image/" + std::string(type + 1)}};
  }

  Json& material() { return json_["materials"][0]; }
  Json& surface() { return material()["pbrMetallicRoughness"]; }

  std::size_t add(const std::vector<float>& numbers, const char* type) {
    const std::size_t width = std::string(type) == "VEC2" ? 2 : 3;
    const std::size_t offset = data_.size(), size = 4 * numbers.size();
    data_.append(reinterpret_cast<const char*>(numbers.data()), size);
    json_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
    json_["accessors"].push_back({{"bufferView", json_["bufferViews"].size() - 1},
                                  {"componentType", 5126},
                                  {"count", numbers.size() / width},
                                  {"type", type}});
    return json_["accessors"].size() - 1;
  }

  /// Sets texture coordinates, v downwards: from `low` at the lower left to `high` at the upper
  /// right.
  void set_uvs(const char* name, float left, float bottom, float right, float top) {
    attributes_[name] = add({left, bottom, right, bottom, right, top, left, top}, "VEC2");
  }

  ImportedMesh import() {
    const Json primitive = {{"attributes", attributes_}, {"material", material_}};
    json_["meshes"] = Json::array({Json{{"primitives", Json::array({primitive})}}});
    const std::array<std::uint16_t, 6> corners = {0, 1, 2, 0, 2, 3};
    Json whole = json_;
    whole["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", sizeof(corners)}});
    whole["accessors"].push_back({{"bufferView", whole["bufferViews"].size() - 1},
                                  {"componentType", 5123},
                                  {"count", 6},
                                  {"type", "SCALAR"}});
    whole["meshes"][0]["primitives"][0]["indices"] = whole["accessors"].size() - 1;
    const std::string data =
        data_ + std::string(reinterpret_cast<const char*>(corners.data()), sizeof(corners));
    whole["buffers"] = {{{"uri", "a.bin"}, {"byteLength", data.size()}}};
    write_file(folder_.path() / "a.bin", data);
    return import_mesh(write_file(folder_.path() / "a.gltf", whole.dump()));
  }

  void expect_color(const Mesh& mesh, float x, float y, const Eigen::Vector3f& expected) {
    const Eigen::Vector3f found = surface_color(mesh, {x, y, 0});
    EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), 1.5f)
        << "at (" << x << ", " << y << "): " << found.transpose() << ", not "
        << expected.transpose();
  }

  std::vector<std::string> notes() {
    std::vector<std::string> out;
    for (const std::string& note : import().notes)
      out.push_back(note.substr((folder_.path() / "a.gltf: ").string().size()));
    return out;
  }

  const Eigen::Vector3f kRed{249, 10, 10}, kGreen{10, 249, 10}, kBlue{10, 10, 249},
      kYellow{249, 249, 10};
  TemporaryDirectory folder_;
  Json json_, attributes_;
  std::string data_;
  std::size_t material_ = 0;
};

TEST_F(GltfSurface, HasThePictureThatItsCoordinatesSay) {
  set_uvs("TEXCOORD_0", 0, 1, 1, 0);
  const ImportedMesh imported = import();
  EXPECT_EQ(imported.mesh.texture.size(), cv::Size(8, 8));
  expect_color(imported.mesh, 0.25f, 0.75f, kRed);
  expect_color(imported.mesh, 0.75f, 0.75f, kGreen);
  expect_color(imported.mesh, 0.25f, 0.25f, kBlue);
  expect_color(imported.mesh, 0.75f, 0.25f, kYellow);
  EXPECT_THAT(imported.notes, IsEmpty());
}

TEST_F(GltfSurface, TakesTheSetOfCoordinatesThatItsMaterialNames) {
  set_uvs("TEXCOORD_0", 0, 1, 1, 0);
  set_uvs("TEXCOORD_1", 0.6f, 0.4f, 0.9f, 0.1f);
  surface()["baseColorTexture"]["texCoord"] = 1;
  expect_color(import().mesh, 0.25f, 0.25f, kGreen);
}

TEST_F(GltfSurface, MovesCoordinatesByTheTransformOfTheTexture) {
  set_uvs("TEXCOORD_0", 0, 1, 1, 0);
  Json& transform = surface()["baseColorTexture"]["extensions"]["KHR_texture_transform"];
  transform = {{"offset", {0.1, 0.6}}, {"scale", {0.3, 0.3}}};
  expect_color(import().mesh, 0.25f, 0.75f, kBlue);
  // The example of the extension's text: the lower left quarter, turned by 90 degrees.
  transform = {{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}};
  expect_color(import().mesh, 0.5f, 0.5f, kBlue);
  // u' = 2 v, v' = -u + 1 of coordinates that run downwards.
  transform = {{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {1, 2}}};
  const Mesh turned = import().mesh;
  expect_color(turned, 0.25f, 0.875f, kBlue);    // u 0.25, v 0.125: 0.25, 0.75
  expect_color(turned, 0.25f, 0.625f, kYellow);  // u 0.25, v 0.375: 0.75, 0.75
  expect_color(turned, 0.75f, 0.875f, kRed);     // u 0.75, v 0.125: 0.25, 0.25
}

TEST_F(GltfSurface, TransformNamesASetOfCoordinatesToo) {
  set_uvs("TEXCOORD_0", 0, 1, 1, 0);
  set_uvs("TEXCOORD_1", 0.6f, 0.4f, 0.9f, 0.1f);
  surface()["baseColorTexture"]["extensions"]["KHR_texture_transform"]["texCoord"] = 1;
  expect_color(import().mesh, 0.25f, 0.25f, kGreen);
}

TEST_F(GltfSurface, PictureRepeatsWithinATriangle) {
  set_uvs("TEXCOORD_0", -0.5f, 2, 2, -0.5f);
  const Mesh mesh = import().mesh;
  for (float u = -0.375f; u < 2; u += 0.25f) {
    for (float v = -0.375f; v < 2; v += 0.25f) {
      const bool right = u - std::floor(u) > 0.5f, below = v - std::floor(v) > 0.5f;
      expect_color(mesh, (u + 0.5f) / 2.5f, (2 - v) / 2.5f,
                   below ? (right ? kYellow : kBlue) : (right ? kGreen : kRed));
    }
  }
}

TEST_F(GltfSurface, PictureIsMirroredOrClampedAsItsSamplerSays) {
  json_["samplers"][0] = {{"wrapS", 33648}, {"wrapT", 33071}};
  set_uvs("TEXCOORD_0", -1, 1.75f, 2, 0.25f);
  const Mesh mesh = import().mesh;
  for (float u = -0.875f; u < 2; u += 0.25f) {
    for (float v = 0.375f; v < 1.7f; v += 0.25f) {
      const float mirrored = u < 0 ? -u : u > 1 ? 2 - u : u;
      const bool right = mirrored > 0.5f, below = v > 0.5f;
      expect_color(mesh, (u + 1) / 3, (1.75f - v) / 1.5f,
                   below ? (right ? kYellow : kBlue) : (right ? kGreen : kRed));
    }
  }
}

TEST_F(GltfSurface, PicturesBesideTheSquareAreMirroredAndClampedToo) {
  json_["samplers"][0] = {{"wrapS", 33648}, {"wrapT", 33648}};
  set_uvs("TEXCOORD_0", 1.1f, 0.4f, 1.4f, 0.1f);  // mirrored: 0.9 to 0.6
  expect_color(import().mesh, 0.25f, 0.25f, kGreen);
  json_["samplers"][0] = {{"wrapS", 33071}, {"wrapT", 33071}};
  expect_color(import().mesh, 0.25f, 0.25f, kGreen);
  set_uvs("TEXCOORD_0", 1.1f, 1.4f, 1.4f, 1.1f);
  expect_color(import().mesh, 0.25f, 0.25f, kYellow);
}

TEST_F(GltfSurface, FactorMultipliesTheLightOfThePicture) {
  set_uvs("TEXCOORD_0", 0, 0.5f, 0.5f, 0);
  surface()["baseColorFactor"] = {0.25, 1, 0, 1};
  // 249 is 0.947 of sRGB's light; a quarter of it is 134. 10 stays, or vanishes.
  expect_color(import().mesh, 0.5f, 0.5f, {134, 10, 0});
}

TEST_F(GltfSurface, FactorWithoutAPictureIsLinearInLight) {
  surface() = {{"baseColorFactor", {0.5, 0.25, 1, 1}}};
  const Mesh mesh = import().mesh;
  EXPECT_TRUE(mesh.texture.empty());
  EXPECT_LT((255 * mesh.color - Eigen::Vector3f(187.5f, 136.9f, 255)).cwiseAbs().maxCoeff(), 0.5f)
      << 255 * mesh.color.transpose();
}

/// Returns 249 of sRGB's range times a share of light.
float red_of(float share) {
  const float light = 0.9473f * share;
  return 255 * (light <= 0.0031308f ? 12.92f * light : 1.055f * std::pow(light, 1 / 2.4f) - 0.055f);
}

TEST_F(GltfSurface, ColorsOfVerticesMultiplyThePictureInLight) {
  attributes_["COLOR_0"] = add({0, 1, 1, 1, 1, 1, 1, 1, 1, 0, 1, 1}, "VEC3");
  for (const float high : {0.4f, 0.1001f}) {  // a picture of many pixels, and one of few
    set_uvs("TEXCOORD_0", 0.1f, high, high, 0.1f);
    const Mesh mesh = import().mesh;
    for (const float x : {0.1f, 0.25f, 0.5f, 0.75f, 0.9f}) {  // red's light rises with x
      const Eigen::Vector3f found = surface_color(mesh, {x, 0.4f, 0});
      EXPECT_NEAR(found[0], red_of(x), x < 0.2f ? 8 : 4) << "at " << x << " of " << high;
      EXPECT_NEAR(found[1], 10, 1.5f);
    }
  }
}

TEST_F(GltfSurface, ColorsOfVerticesArePaintedOnAPictureWhoseTrianglesShareNoPixels) {
  write_picture("four.png", cv::Mat3b(64, 64, cv::Vec3b(10, 10, 249)));
  attributes_["COLOR_0"] = add({0, 1, 1, 1, 1, 1, 1, 1, 1, 0, 1, 1}, "VEC3");
  set_uvs("TEXCOORD_0", 0, 1, 1, 0);
  const Mesh mesh = import().mesh;
  EXPECT_EQ(mesh.texture.size(), cv::Size(64, 64)) << "renderers filter it as they do the picture";
  for (const float x : {0.1f, 0.25f, 0.5f, 0.75f, 0.9f})
    EXPECT_NEAR(surface_color(mesh, {x, 0.4f, 0})[0], red_of(x), 2) << "at " << x;
}

TEST_F(GltfSurface, ColorsOfVerticesWithoutAPictureGoFromCornerToCornerInLight) {
  surface() = {{"baseColorFactor", {1, 0.25, 1, 1}}};
  attributes_["COLOR_0"] = add({0, 1, 1, 1, 1, 1, 1, 1, 1, 0, 1, 1}, "VEC3");
  const Eigen::Vector3f found = surface_color(import().mesh, {0.5f, 0.25f, 0});
  EXPECT_NEAR(found[0], 187.5f, 3) << "half of the light";
  EXPECT_NEAR(found[1], 136.9f, 1.5f) << "a quarter of the light";
}

TEST_F(GltfSurface, PartsWithAndWithoutColorsKeepTheirs) {
  set_uvs("TEXCOORD_0", 0, 0.5f, 0.5f, 0);
  const std::size_t white = add(std::vector<float>(12, 1), "VEC3");
  attributes_["COLOR_0"] = white;
  expect_color(import().mesh, 0.5f, 0.5f, kRed);
}

TEST_F(GltfSurface, DiffuseOfSpecularGlossinessIsItsColor) {
  set_uvs("TEXCOORD_0", 0, 0.5f, 0.5f, 0);
  surface() = {{"baseColorFactor", {0, 0, 0, 1}}};
  material()["extensions"]["KHR_materials_pbrSpecularGlossiness"] = {
      {"diffuseFactor", {0.25, 1, 1, 1}}, {"diffuseTexture", {{"index", 0}}}};
  expect_color(import().mesh, 0.5f, 0.5f, {134, 10, 10});
}

TEST_F(GltfSurface, EmissionOfABlackSurfaceIsItsColor) {
  set_uvs("TEXCOORD_0", 0, 0.5f, 0.5f, 0);
  surface() = {{"baseColorFactor", {0, 0, 0, 1}}};
  material()["emissiveFactor"] = {1, 1, 1};
  material()["emissiveTexture"]["index"] = 0;
  expect_color(import().mesh, 0.5f, 0.5f, kRed);
  EXPECT_THAT(notes(), ElementsAre("material 'label' is not drawn as the file says: its base "
                                   "colour is black, so its emission is its colour"));
}

TEST_F(GltfSurface, OneNoteNamesWhatAMaterialHasThatIsNotDrawn) {
  set_uvs("TEXCOORD_0", 0, 1, 1, 0);
  surface()["metallicRoughnessTexture"]["index"] = 0;
  material()["normalTexture"]["index"] = 0;
  material()["emissiveFactor"] = {0, 0.5, 0};
  material()["alphaMode"] = "BLEND";
  material()["doubleSided"] = true;
  material()["extensions"] = {{"KHR_materials_unlit", Json::object()},
                              {"MINE_glitter", Json::object()}};
  EXPECT_THAT(notes(),
              ElementsAre("material 'label' is not drawn as the file says: emissiveFactor (it adds "
                          "no light), metallicRoughnessTexture, normalTexture, KHR_materials_unlit "
                          "(it is lit as all surfaces are), MINE_glitter, alphaMode BLEND (it is "
                          "opaque)"));
}

TEST_F(GltfSurface, PictureThatRepeatsTooOftenIsDrawnSmallerAndSaysSo) {
  cv::Mat3b picture(512, 512, cv::Vec3b(0, 0, 0));
  picture.colRange(256, 512).setTo(cv::Vec3b(200, 200, 200));
  write_picture("four.png", picture);
  set_uvs("TEXCOORD_0", 0, 40, 40, 0);
  expect_color(import().mesh, 0.25f / 40, 0.5f, {0, 0, 0});
  expect_color(import().mesh, 0.75f / 40, 0.5f, {200, 200, 200});
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("a texture of 512 x 512 pixels goes on over 40 times "
                                             "its size: drawn 5.0 times smaller")));
}

TEST_F(GltfSurface, MaterialsAndPicturesInsideTheFileAreFoundByNumberWhateverIsUsedFirst) {
  set_uvs("TEXCOORD_0", 0, 0.5f, 0.5f, 0);
  for (const uchar blue : {10, 60, 110, 160})
    json_["images"].push_back(picture_inside(".png", {blue, 20, 30}));  // 1 to 4
  json_["textures"] = Json::array();
  json_["materials"] = Json::array();
  for (const int image : {4, 2, 0, 3, 1}) {
    json_["materials"].push_back(
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", json_["textures"].size()}}}}}});
    json_["textures"].push_back({{"source", image}});
  }
  material_ = 1;
  expect_color(import().mesh, 0.5f, 0.5f, {30, 20, 60});
  material_ = 4;
  expect_color(import().mesh, 0.5f, 0.5f, {30, 20, 10});
  json_["materials"][4]["normalTexture"]["index"] = 0;
  expect_color(import().mesh, 0.5f, 0.5f, {30, 20, 10});
  material_ = 2;
  expect_color(import().mesh, 0.5f, 0.5f, kRed);
}

TEST_F(GltfSurface, WebpPicturesInsideTheFileAreRead) {
  set_uvs("TEXCOORD_0", 0, 0.5f, 0.5f, 0);
  json_["images"].push_back(picture_inside(".webp", {110, 110, 110}));
  json_["textures"][0] = {{"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}};
  json_["extensionsRequired"] = {"EXT_texture_webp"};
  expect_color(import().mesh, 0.5f, 0.5f, {110, 110, 110});
}

TEST_F(GltfSurface, NamesOfPicturesAreUris) {
  set_uvs("TEXCOORD_0", 0, 0.5f, 0.5f, 0);
  write_picture("my picture.png", cv::Mat3b(4, 4, cv::Vec3b(30, 20, 10)));
  json_["images"][0]["uri"] = "my%20picture.png";
  expect_color(import().mesh, 0.5f, 0.5f, {10, 20, 30});
}

}  // namespace
}  // namespace hypotrack::test
