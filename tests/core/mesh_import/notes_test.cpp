// Every reader names what a file has that is not used.

#include <gmock/gmock.h>

#include "hypotrack/mesh_io.hpp"
#include "mesh_files.hpp"

namespace hypotrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

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

}  // namespace
}  // namespace hypotrack::test
