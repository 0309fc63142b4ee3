#pragma once

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "glb_writer.hpp"
#include "hypotrack/api/mesh_io.hpp"
#include "mesh_files.hpp"

namespace hypotrack::test {

/// A test that reads tetrahedra whose glTF it writes.
class GltfTest : public ::testing::Test {
 protected:
  using Floats3 = std::vector<std::array<float, 3>>;
  using Add = std::function<void(GlbWriter&, Json&)>;  ///< adds attributes of the vertices

  static const Floats3& corners() {
    static const Floats3 points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    return points;
  }

  /// Writes a tetrahedron with further attributes, and of further positions if `add` says so.
  static GlbWriter tetrahedron(const Add& add) {
    GlbWriter writer;
    Json attributes = Json::object();
    add(writer, attributes);
    if (!attributes.contains("POSITION"))
      attributes["POSITION"] = writer.add(corners(), "VEC3", kFloat);
    const std::vector<std::uint8_t> indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    const int accessor = writer.add(indices, "SCALAR", kUnsignedByte);
    Json& json = writer.json();
    json["meshes"] = {
        {{"name", "body"},
         {"primitives", {{{"attributes", attributes}, {"indices", accessor}, {"mode", 4}}}}}};
    json["nodes"] = {{{"name", "body"}, {"mesh", 0}}};
    json["scenes"] = {{{"nodes", {0}}}};
    return writer;
  }
  /// Writes a tetrahedron that two bones at the origin hold, `root` and `tip`, without bind
  /// matrices.
  static GlbWriter skinned(const Add& add) {
    GlbWriter writer = tetrahedron(add);
    Json& json = writer.json();
    json["nodes"][0]["skin"] = 0;
    json["nodes"].push_back({{"name", "root"}, {"children", {2}}});
    json["nodes"].push_back({{"name", "tip"}});
    json["skins"] = {{{"joints", {1, 2}}}};
    json["scenes"] = {{{"nodes", {0, 1}}}};
    return writer;
  }

  std::filesystem::path file(const char* name, std::string_view bytes) {
    return write_file(folder_.path() / name, bytes);
  }
  ImportedMesh read(const GlbWriter& writer, const MeshImportOptions& options = {}) {
    return import_mesh(file("a.glb", writer.finish()), options);
  }
  std::string error(const GlbWriter& writer) {
    return import_error(file("a.glb", writer.finish()));
  }

  TemporaryDirectory folder_;
};

}  // namespace hypotrack::test
