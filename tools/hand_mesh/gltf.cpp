#include "gltf.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Vector3f;
using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "glTF is little endian");

// Constants of the glTF 2.0 specification.
constexpr int kUnsignedByte = 5121, kUnsignedShort = 5123, kFloat = 5126;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr int kLinear = 9729, kLinearMipmapLinear = 9987, kClampToEdge = 33071;
constexpr double kMetresPerMillimetre = 1e-3;

/// The binary chunk, its views and accessors, filled one array after the other.
class Buffer {
 public:
  explicit Buffer(json& document) : document_(document) {
    document_["bufferViews"] = json::array();
    document_["accessors"] = json::array();
  }

  int add_view(const void* data, size_t size, int target = 0) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    json view{{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}};
    if (target != 0) view["target"] = target;
    bytes_.append(static_cast<const char*>(data), size);
    document_["bufferViews"].push_back(view);
    return static_cast<int>(document_["bufferViews"].size()) - 1;
  }

  template <typename T>
  int add(const std::vector<T>& values, int components, const char* type, int component_type,
          int target = kArrayBuffer) {
    const int view = add_view(values.data(), values.size() * sizeof(T), target);
    document_["accessors"].push_back({{"bufferView", view},
                                      {"componentType", component_type},
                                      {"count", values.size() / components},
                                      {"type", type}});
    return static_cast<int>(document_["accessors"].size()) - 1;
  }

  std::string take() {
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    document_["buffers"] = {{{"byteLength", bytes_.size()}}};
    return std::move(bytes_);
  }

 private:
  json& document_;
  std::string bytes_;
};

Vector3f metres(const Eigen::Vector3d& millimetres) {
  return (kMetresPerMillimetre * millimetres).cast<float>();
}

void append(std::vector<float>& values, const Vector3f& v) {
  values.insert(values.end(), {v.x(), v.y(), v.z()});
}

json add_primitive(const HandAsset& hand, Buffer& buffer, json& document) {
  std::vector<float> positions, normals, coordinates, weights;
  std::vector<uint8_t> joints;
  const TextureMap& map = hand.texture_map;
  Vector3f low = Vector3f::Constant(1e9f), high = -low;
  for (size_t i = 0; i < map.coordinates.size(); ++i) {
    const int v = map.vertex_of[i];
    const Vector3f p = metres(hand.mesh.vertices[v]);
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
    append(positions, p);
    append(normals, hand.attributes.normals[v].cast<float>().normalized());
    for (int k = 0; k < 2; ++k) coordinates.push_back(static_cast<float>(map.coordinates[i][k]));
    for (int k = 0; k < 4; ++k) {
      joints.push_back(static_cast<uint8_t>(hand.weights[v].bones[k]));
      weights.push_back(static_cast<float>(hand.weights[v].weights[k]));
    }
  }
  std::vector<uint16_t> indices;
  for (const Triangle& t : map.triangles)
    for (int i : t) indices.push_back(static_cast<uint16_t>(i));
  json attributes{{"POSITION", buffer.add(positions, 3, "VEC3", kFloat)},
                  {"NORMAL", buffer.add(normals, 3, "VEC3", kFloat)},
                  {"TEXCOORD_0", buffer.add(coordinates, 2, "VEC2", kFloat)},
                  {"JOINTS_0", buffer.add(joints, 4, "VEC4", kUnsignedByte)},
                  {"WEIGHTS_0", buffer.add(weights, 4, "VEC4", kFloat)}};
  json& position = document["accessors"][attributes["POSITION"].get<int>()];
  position["min"] = {low.x(), low.y(), low.z()};
  position["max"] = {high.x(), high.y(), high.z()};
  const int elements = buffer.add(indices, 1, "SCALAR", kUnsignedShort, kElementArrayBuffer);
  return {{"attributes", attributes}, {"indices", elements}, {"material", 0}};
}

/// Node 0 is the mesh, bone b is node b + 1.
void add_skeleton(const HandAsset& hand, Buffer& buffer, json& document) {
  std::vector<float> inverse_binds;
  json joints = json::array();
  for (size_t b = 0; b < hand.skeleton.size(); ++b) {
    const SkeletonBone& bone = hand.skeleton[b];
    Eigen::Isometry3d local = bone.hand_from_bone;
    if (bone.parent >= 0) local = hand.skeleton[bone.parent].hand_from_bone.inverse() * local;
    const Vector3f t = metres(local.translation());
    const Eigen::Quaternionf q = Eigen::Quaterniond(local.linear()).normalized().cast<float>();
    json node{{"name", bone.name},
              {"translation", {t.x(), t.y(), t.z()}},
              {"rotation", {q.x(), q.y(), q.z(), q.w()}}};
    for (size_t c = 0; c < hand.skeleton.size(); ++c)
      if (hand.skeleton[c].parent == static_cast<int>(b)) node["children"].push_back(c + 1);
    document["nodes"].push_back(node);
    joints.push_back(b + 1);
    Eigen::Isometry3d inverse = bone.hand_from_bone.inverse();
    inverse.translation() *= kMetresPerMillimetre;
    const Eigen::Matrix4f m = inverse.matrix().cast<float>();  // column-major, as glTF wants it
    inverse_binds.insert(inverse_binds.end(), m.data(), m.data() + 16);
  }
  const int accessor = buffer.add(inverse_binds, 16, "MAT4", kFloat, 0);
  document["skins"] = {{{"inverseBindMatrices", accessor}, {"joints", joints}, {"skeleton", 1}}};
}

void add_material(const HandAsset& hand, Buffer& buffer, json& document) {
  std::vector<uchar> png;
  if (!cv::imencode(".png", hand.texture, png, {cv::IMWRITE_PNG_COMPRESSION, 6}))
    throw std::runtime_error("hand mesh: OpenCV cannot write PNG");
  document["images"] = {{{"name", "skin"},
                         {"mimeType", "image/png"},
                         {"bufferView", buffer.add_view(png.data(), png.size())}}};
  document["samplers"] = {{{"magFilter", kLinear},
                           {"minFilter", kLinearMipmapLinear},
                           {"wrapS", kClampToEdge},
                           {"wrapT", kClampToEdge}}};
  document["textures"] = {{{"sampler", 0}, {"source", 0}}};
  document["materials"] = {{{"name", "skin"},
                            {"pbrMetallicRoughness",
                             {{"baseColorTexture", {{"index", 0}}},
                              {"metallicFactor", 0.0},
                              {"roughnessFactor", 0.65}}}}};
}

void append_word(std::string& bytes, uint32_t word) {
  char raw[4];
  std::memcpy(raw, &word, 4);
  bytes.append(raw, 4);
}

void append_chunk(std::string& bytes, std::string chunk, uint32_t type, char padding) {
  chunk.resize((chunk.size() + 3) / 4 * 4, padding);
  append_word(bytes, static_cast<uint32_t>(chunk.size()));
  append_word(bytes, type);
  bytes += chunk;
}

}  // namespace

std::string to_glb(const HandAsset& hand) {
  json document{{"asset", {{"version", "2.0"}, {"generator", "hypotrack_hand_mesh"}}}};
  Buffer buffer(document);
  document["nodes"] = {{{"name", "hypotrack_hand"}, {"mesh", 0}, {"skin", 0}}};
  const json primitive = add_primitive(hand, buffer, document);
  document["meshes"] = {{{"name", "hypotrack_hand"}, {"primitives", {primitive}}}};
  add_skeleton(hand, buffer, document);
  add_material(hand, buffer, document);
  document["scenes"] = json::array({{{"nodes", json::array({0, 1})}}});
  document["scene"] = 0;
  const std::string binary = buffer.take();

  std::string chunks;
  append_chunk(chunks, document.dump(), 0x4e4f534a, ' ');  // "JSON"
  append_chunk(chunks, binary, 0x004e4942, '\0');          // "BIN"
  std::string glb = "glTF";
  append_word(glb, 2);
  append_word(glb, static_cast<uint32_t>(12 + chunks.size()));
  return glb + chunks;
}

}  // namespace hypotrack::hand_mesh
