#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/mesh_io.hpp"
#include "mesh_files.hpp"

namespace hypotrack::test {
namespace {

/// xorshift: the same files on every machine.
class Random {
 public:
  explicit Random(std::uint32_t seed) : state_(seed) {}
  std::uint32_t below(std::size_t limit) {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 17;
    state_ ^= state_ << 5;
    return state_ % static_cast<std::uint32_t>(limit);
  }

 private:
  std::uint32_t state_;
};

void expect_sound(const ImportedMesh& imported) {
  const Mesh& mesh = imported.mesh;
  ASSERT_GT(mesh.triangles.cols(), 0);
  EXPECT_TRUE(mesh.vertices.allFinite());
  EXPECT_GE(mesh.triangles.minCoeff(), 0);
  EXPECT_LT(mesh.triangles.maxCoeff(), mesh.vertices.cols());
  if (!imported.bones.empty()) {
    EXPECT_LT(mesh.bone_indices.maxCoeff(), static_cast<int>(imported.bones.size()));
    EXPECT_NEAR(mesh.bone_weights.colwise().sum().minCoeff(), 1, 1e-5);
  }
}

/// Changes a few bytes of a good file, again and again: the importer may refuse, nothing else.
void mutate(const char* name, const std::string& good, std::uint32_t seed) {
  TemporaryDirectory folder;
  Random random(seed);
  int refused = 0;
  constexpr int kFiles = 60;
  for (int i = 0; i < kFiles; ++i) {
    std::string bytes = good;
    for (std::uint32_t changes = 1 + random.below(4); changes > 0; --changes) {
      bytes[random.below(bytes.size())] = static_cast<char>(random.below(256));
    }
    const auto path = write_file(folder.path() / name, bytes);
    try {
      expect_sound(import_mesh(path));
    } catch (const DataError& error) {
      EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(refused, 0) << "no change was noticed: are the files read at all?";
}

TEST(MutatedMesh, ObjIsReadOrRefused) { mutate("a.obj", obj(), 1); }
TEST(MutatedMesh, StlIsReadOrRefused) { mutate("a.stl", binary_stl(), 2); }
TEST(MutatedMesh, PlyIsReadOrRefused) {
  mutate("a.ply", ply(), 4);
  mutate("b.ply", binary_ply(), 5);
}
TEST(MutatedMesh, GlbIsReadOrRefused) { mutate("a.glb", glb({}), 3); }

}  // namespace
}  // namespace hypotrack::test
