#include <fstream>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "plugin_fixtures.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(DataFile, IsLookedForWhereTheVariableSays) {
  const TemporaryDirectory folder;
  std::ofstream(folder.path() / "hand.glb") << "x";
  const ScopedVariable variable("HYPOTRACK_DATA_PATH", folder.path().string());
  EXPECT_EQ(data_file("hand.glb"), folder.path() / "hand.glb");
}

TEST(DataFile, ThatIsNotThereNamesTheFileAndTheVariable) {
  const ScopedVariable variable("HYPOTRACK_DATA_PATH", "/nowhere");
  EXPECT_EQ(
      message_of<DataError>([] { data_file("hand.glb"); }),
      "/nowhere/hand.glb: there is no such file; it comes with hypotrack. HYPOTRACK_DATA_PATH "
      "says to look there");
}

TEST(DataFile, LiesBesideTheLibraryOtherwise) {
  const ScopedVariable variable("HYPOTRACK_DATA_PATH", "");
  EXPECT_THAT(
      message_of<DataError>([] { data_file("no_such_file"); }),
      AllOf(StartsWith(std::filesystem::canonical(build_dir()).string()),
            HasSubstr("share/hypotrack/no_such_file: there is no such file"),
            EndsWith("or set HYPOTRACK_DATA_PATH to the folder that holds 'no_such_file'")));
}

}  // namespace
}  // namespace hypotrack::test
