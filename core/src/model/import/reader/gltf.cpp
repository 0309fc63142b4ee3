#include "model/import/reader/gltf.hpp"

#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "hypotrack/text_file.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

using Json = nlohmann::json;

Json read_json(const std::string& file) {
  const std::string bytes = read_whole(file).value_or("");
  if (!bytes.starts_with("glTF")) return Json::parse(bytes);
  // GLB: a header of 12 bytes, then chunks of length, type and data; the first chunk is the JSON.
  std::uint32_t length = 0;
  if (bytes.size() < 20) throw std::runtime_error("the GLB file ends within its header");
  std::memcpy(&length, bytes.data() + 12, sizeof(length));
  if (length > bytes.size() - 20) throw std::runtime_error("the GLB file ends within its JSON");
  return Json::parse(bytes.substr(20, length));
}

/// Returns a value as a whole number. Throws std::runtime_error if it is anything else.
std::uint64_t whole(const Json& value, const char* name) {
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  throw std::runtime_error(std::string("a value of '") + name + "' is no whole number from 0 on");
}

/// glTF 2.0, "mesh.primitive.mode".
std::uint64_t triangles_of(std::uint64_t mode, std::uint64_t corners) {
  constexpr int kTriangles = 4;
  constexpr int kStrip = 5;
  constexpr int kFan = 6;
  if (mode == kTriangles) return corners / 3;
  return (mode == kStrip || mode == kFan) && corners > 2 ? corners - 2 : 0;
}

}  // namespace

std::uint64_t count_gltf_triangles(const std::string& file) {
  const Json json = read_json(file);
  std::uint64_t triangles = 0;
  if (!json.contains("meshes")) return 0;
  for (const Json& mesh : json.at("meshes")) {
    for (const Json& primitive : mesh.at("primitives")) {
      const Json& corners = primitive.contains("indices")
                                ? primitive.at("indices")
                                : primitive.at("attributes").at("POSITION");
      const Json& accessor = json.at("accessors").at(whole(corners, "indices or POSITION"));
      const std::uint64_t mode = primitive.contains("mode") ? whole(primitive["mode"], "mode") : 4;
      triangles += triangles_of(mode, whole(accessor.at("count"), "count"));
    }
  }
  return triangles;
}

}  // namespace hypotrack::mesh_wire::internal
