// Every reader names what a file has that is not used.

#include <gmock/gmock.h>

#include <array>
#include <cstring>

#include "hypotrack/api/mesh_io.hpp"
#include "mesh_files.hpp"

namespace hypotrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class MeshNotes : public ::testing::Test {
 protected:
  /// Returns the notes on a file without its path, with which each has to begin.
  std::vector<std::string> notes(const char* name, std::string_view bytes) {
    const auto path = write_file(folder_.path() / name, bytes);
    std::vector<std::string> texts;
    for (const std::string& note : import_mesh(path).notes) {
      EXPECT_TRUE(note.starts_with(path.string() + ": ")) << note;
      texts.push_back(note.substr(std::min(note.size(), path.string().size() + 2)));
    }
    return texts;
  }
  TemporaryDirectory folder_;
};

TEST_F(MeshNotes, FilesThatAreReadWholeHaveNone) {
  EXPECT_THAT(notes("a.obj", "# made up\no a\ng b\ns 1\n" + obj()), IsEmpty());
  EXPECT_THAT(notes("a.stl", binary_stl()), IsEmpty());
  EXPECT_THAT(notes("a.ply", ply()), IsEmpty());
  EXPECT_THAT(notes("a.glb", glb({})), IsEmpty());
}

TEST_F(MeshNotes, ObjNamesItsUnknownStatementsWithTheirFirstLine) {
  EXPECT_THAT(notes("a.obj", "l 1 2\n" + obj() + "cstype bezier\nl 3 4\nmine 7\n"),
              ElementsAre("statements that are not read: 1 `cstype` from line 10 (curves and "
                          "surfaces: export triangles), 2 `l` from line 1 (lines), 1 `mine` from "
                          "line 12"));
}

TEST_F(MeshNotes, ObjNamesFacesWithoutAMaterial) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const std::string faces = "f 1 3 2\nf 1 2 4\n", more = "f 1 4 3\nf 2 3 4\n";
  EXPECT_THAT(notes("none.obj", points + faces + more), IsEmpty());
  EXPECT_THAT(
      notes("late.obj", points + faces + "usemtl red\n" + more),
      testing::Contains(StartsWith("faces before the first `usemtl` (2) have no material")));
}

TEST_F(MeshNotes, PlyNamesItsUnknownElementsAndProperties) {
  EXPECT_THAT(notes("a.ply",
                    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                    "property float y\nproperty float z\nproperty float quality\n"
                    "element face 1\nproperty list uchar int vertex_indices\n"
                    "property uchar red\nelement edge 1\nproperty int vertex1\nend_header\n"
                    "0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2 255\n0\n"),
              ElementsAre("elements and properties that are not read: vertex quality, face red, "
                          "edge"));
}

TEST_F(MeshNotes, PlyNamesColoursUnderOldNamesAndRefusesStrips) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\n";
  const std::string corners = "0 0 0 9\n1 0 0 9\n0 1 0 9\n1 1 0 9\n";
  EXPECT_THAT(notes("a.ply", head +
                                 "property uchar diffuse_red\nelement face 1\n"
                                 "property list uchar int vertex_indices\nend_header\n" +
                                 corners + "3 0 1 2\n"),
              ElementsAre("elements and properties that are not read: vertex diffuse_red"));
  const auto strips = write_file(folder_.path() / "b.ply",
                                 head +
                                     "property uchar red\nelement tristrips 1\n"
                                     "property list int int vertex_indices\nend_header\n" +
                                     corners + "4 0 1 2 3\n");
  EXPECT_THAT(import_error(strips), HasSubstr("its triangles are in strips (element tristrips)"));
}

/// Returns binary_stl() with the attributes of its four facets.
std::string stl_with(const std::string& header, std::array<std::uint16_t, 4> attributes) {
  std::string file = binary_stl();
  file.replace(0, header.size(), header);
  for (std::size_t i = 0; i < attributes.size(); ++i)
    std::memcpy(file.data() + 84 + 50 * i + 48, &attributes[i], sizeof(attributes[i]));
  return file;
}

TEST_F(MeshNotes, StlNamesAttributesThatAreNotReadAsColours) {
  EXPECT_THAT(notes("viscam.stl", stl_with("", {0x801f, 0x83e0, 0, 0xfc00})), IsEmpty());
  EXPECT_THAT(notes("odd.stl", stl_with("", {0, 5, 0x7fff, 0})),
              ElementsAre("the attributes of 2 facets are not read: export PLY, OBJ or GLB if they "
                          "are colours"));
  EXPECT_THAT(notes("magics.stl", stl_with("COLOR=", {0x1f, 0x3e0, 0x8000, 0})),
              ElementsAre(StartsWith("the attributes of 3 facets are not read, which have colours "
                                     "as Materialise Magics")));
}

}  // namespace
}  // namespace hypotrack::test
