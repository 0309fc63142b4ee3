#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include <Eigen/Geometry>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "gltf.hpp"
#include "the_hand.hpp"

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

std::string committed_file() {
  std::ifstream stream(HAND_FILE, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

uint32_t word(const std::string& bytes, size_t offset) {
  uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, 4);
  return value;
}

struct Glb {
  json document;
  std::string binary;
};

Glb parse(const std::string& bytes) {
  const uint32_t length = word(bytes, 12);
  return {json::parse(bytes.substr(20, length)), bytes.substr(20 + length + 8)};
}

/// The numbers of an accessor: floats as they are, indices as floats.
std::vector<float> numbers(const Glb& glb, const json& accessor) {
  const json& view = glb.document["bufferViews"][accessor["bufferView"].get<size_t>()];
  const char* first = glb.binary.data() + view["byteOffset"].get<size_t>();
  const auto as_floats = [&]<typename T>(T) {
    std::vector<T> out(view["byteLength"].get<size_t>() / sizeof(T));
    std::memcpy(out.data(), first, out.size() * sizeof(T));
    return std::vector<float>(out.begin(), out.end());
  };
  switch (accessor["componentType"].get<int>()) {
    case 5126:
      return as_floats(float{});
    case 5123:
      return as_floats(uint16_t{});
    case 5121:
      return as_floats(uint8_t{});
    default:
      return as_floats(uint32_t{});
  }
}

cv::Mat embedded_texture(const Glb& glb) {
  const json view = glb.document["bufferViews"][glb.document["images"][0]["bufferView"].get<int>()];
  const auto first = glb.binary.begin() + view["byteOffset"].get<long>();
  return cv::imdecode(std::vector<uchar>(first, first + view["byteLength"].get<long>()),
                      cv::IMREAD_COLOR);
}

TEST(HandFile, IsTheSameBytesOnEveryRun) {
  const std::string again = to_glb(make_hand(the_hand().texture.cols));
  EXPECT_TRUE(again == to_glb(the_hand()));
}

// Another processor's sines may differ in their last bit.
TEST(HandFile, IsWhatTheGeneratorMakes) {
  const Glb made = parse(to_glb(the_hand()));
  const Glb file = parse(committed_file());
  EXPECT_LE(cv::norm(embedded_texture(file), the_hand().texture, cv::NORM_INF), 1);
  const json& accessors = made.document["accessors"];
  ASSERT_EQ(accessors.size(), file.document["accessors"].size());
  for (size_t i = 0; i < accessors.size(); ++i) {
    const std::vector<float> expected = numbers(made, accessors[i]);
    const std::vector<float> found = numbers(file, file.document["accessors"][i]);
    ASSERT_FALSE(expected.empty());
    EXPECT_THAT(found, testing::Pointwise(testing::FloatNear(1e-5f), expected)) << "accessor " << i;
  }
}

TEST(HandFile, IsAWellFormedGlb) {
  const std::string bytes = committed_file();
  ASSERT_GT(bytes.size(), 100'000u);
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word(bytes, 4), 2u);
  EXPECT_EQ(word(bytes, 8), bytes.size());
  EXPECT_EQ(word(bytes, 12) % 4, 0u);
  const Glb glb = parse(bytes);
  EXPECT_EQ(glb.document["buffers"][0]["byteLength"], glb.binary.size());
  for (const json& view : glb.document["bufferViews"]) {
    EXPECT_EQ(view["byteOffset"].get<size_t>() % 4, 0u);
    EXPECT_LE(view["byteOffset"].get<size_t>() + view["byteLength"].get<size_t>(),
              glb.binary.size());
  }
}

TEST(HandFile, EmbedsTheTextureAsPng) {
  const cv::Mat image = embedded_texture(parse(to_glb(the_hand())));
  ASSERT_EQ(image.size(), the_hand().texture.size());
  EXPECT_EQ(cv::norm(image, the_hand().texture, cv::NORM_INF), 0);
}

TEST(HandFile, HasInverseBindMatricesThatFitTheNodes) {
  const Glb glb = parse(committed_file());
  const json& skin = glb.document["skins"][0];
  const json accessor = glb.document["accessors"][skin["inverseBindMatrices"].get<int>()];
  const json view = glb.document["bufferViews"][accessor["bufferView"].get<int>()];
  ASSERT_EQ(skin["joints"].size(), 21u);
  std::vector<Eigen::Isometry3f> global(glb.document["nodes"].size(),
                                        Eigen::Isometry3f::Identity());
  for (size_t n = 1; n < global.size(); ++n) {  // parents come first
    const json& node = glb.document["nodes"][n];
    const auto t = node["translation"].get<std::vector<float>>();
    const auto r = node["rotation"].get<std::vector<float>>();
    global[n] = global[n] * Eigen::Translation3f(t[0], t[1], t[2]) *
                Eigen::Quaternionf(r[3], r[0], r[1], r[2]);
    if (node.contains("children"))
      for (const json& child : node["children"]) global[child.get<size_t>()] = global[n];
  }
  for (size_t j = 0; j < 21; ++j) {
    Eigen::Matrix4f inverse_bind;
    std::memcpy(inverse_bind.data(), glb.binary.data() + view["byteOffset"].get<size_t>() + 64 * j,
                64);
    const Eigen::Matrix4f product = global[skin["joints"][j].get<size_t>()].matrix() * inverse_bind;
    EXPECT_TRUE(product.isIdentity(1e-5f)) << product;
  }
}

TEST(HandFile, LoadsThroughAssimpWithAllBonesInMetres) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(HAND_FILE, aiProcess_ValidateDataStructure);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumMeshes, 1u);
  const aiMesh& mesh = *scene->mMeshes[0];
  EXPECT_EQ(mesh.mNumFaces, the_hand().mesh.triangles.size());
  EXPECT_TRUE(mesh.HasNormals() && mesh.HasTextureCoords(0));
  EXPECT_EQ(scene->mNumTextures, 1u);
  std::set<std::array<float, 3>> welded;
  float highest = 0;
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D& p = mesh.mVertices[v];
    welded.insert({p.x, p.y, p.z});
    highest = std::max(highest, p.y);
  }
  EXPECT_EQ(welded.size(), the_hand().mesh.vertices.size());
  EXPECT_NEAR(highest, 0.177, 0.02);
  std::set<std::string> names;
  for (unsigned b = 0; b < mesh.mNumBones; ++b) names.insert(mesh.mBones[b]->mName.C_Str());
  for (const SkeletonBone& bone : the_hand().skeleton)
    EXPECT_TRUE(names.contains(bone.name)) << bone.name;
}

TEST(HandRig, NamesEveryBoneAndEndsTheDigitsAtTheirTips) {
  const YAML::Node rig = YAML::LoadFile(RIG_FILE);
  ASSERT_EQ(rig["bones"].size(), the_hand().skeleton.size());
  for (const SkeletonBone& bone : the_hand().skeleton) {
    YAML::Node entry;
    for (const YAML::Node& b : rig["bones"])
      if (b["name"].as<std::string>() == bone.name) entry.reset(b);
    ASSERT_TRUE(entry.IsMap()) << bone.name;
    EXPECT_EQ(entry["joint"].as<std::string>(), bone.name);
    const std::string parent = bone.parent >= 0 ? the_hand().skeleton[bone.parent].name : "";
    EXPECT_EQ(entry["parent"].as<std::string>(""), parent);
    if (!bone.name.ends_with("_3")) continue;
    const auto end = entry["end_at"].as<std::vector<double>>();
    const Vector3d tip = bone.hand_from_bone * Vector3d(0, bone.length, 0) / 1000;
    EXPECT_LT((Vector3d(end[0], end[1], end[2]) - tip).norm(), 1e-6)
        << bone.name << " ends at " << tip.transpose();
  }
}

}  // namespace
}  // namespace hypotrack::hand_mesh
