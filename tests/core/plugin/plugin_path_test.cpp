#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "plugin_fixtures.hpp"

namespace hypotrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::StartsWith;

constexpr const char* kVariable = "HYPOTRACK_PLUGIN_PATH";

std::filesystem::path own_folder() { return std::filesystem::canonical(plugin_dir()); }

TEST(PluginPath, IsTheArgumentThenTheVariableThenTheBuild) {
  const ScopedVariable variable(kVariable, "/b:/c/");
  EXPECT_THAT(PluginLoader({"/a"}).search_path(), ElementsAre("/a", "/b", "/c", own_folder()));
}

TEST(PluginPath, EmptyElementsAreNotTheWorkingDirectory) {
  const ScopedVariable variable(kVariable, ":/b::");
  EXPECT_THAT(PluginLoader({""}).search_path(), ElementsAre("/b", own_folder()));
}

TEST(PluginPath, RelativeArgumentsBecomeAbsolute) {
  const ScopedVariable variable(kVariable, "");
  EXPECT_EQ(PluginLoader({"plugins"}).search_path().front(),
            std::filesystem::current_path() / "plugins");
}

TEST(PluginPath, RelativeElementsOfTheVariableAreRefused) {
  const ScopedVariable variable(kVariable, "/b:plugins");
  EXPECT_EQ(
      message_of<PluginError>([] { PluginLoader{}; }),
      "HYPOTRACK_PLUGIN_PATH: 'plugins' is a relative path, so that what is loaded would depend "
      "on the working directory; expected absolute folders with ':' between them");
}

TEST(PluginPath, FoldersAreListedOnce) {
  const ScopedVariable variable(kVariable, "/a:" + own_folder().string());
  EXPECT_THAT(PluginLoader({"/a/"}).search_path(), ElementsAre("/a", own_folder()));
}

}  // namespace
}  // namespace hypotrack::test
