#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "plugin_fixtures.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

ConfigNode config(const std::string& text) {
  return ConfigNode::parse(text, "scene.yaml").get("optimizer");
}

std::unique_ptr<Optimizer> make(const std::string& text, std::string* resolved = nullptr) {
  PluginLoader loader({fixtures("good"), fixtures("bad")});
  return loader.make<Optimizer>(config(text), nullptr, {"weight"}, resolved);
}

std::string plugin_error(const std::string& name) {
  return message_of<PluginError>([&] { make("optimizer: {type: " + name + "}"); });
}

std::string config_error(const std::string& text) {
  return message_of<ConfigError>([&] { make(text); });
}

TEST(PluginLoader, MakesWhatTheSceneSays) {
  EXPECT_EQ(make("optimizer: {type: sample, particles: 5}")->default_evaluations(), 5);
  EXPECT_EQ(make("optimizer: {type: sample, weight: 3}")->default_evaluations(), 64);
}

TEST(PluginLoader, ReportsAllParametersWithTheirValues) {
  std::string resolved;
  make("optimizer: {range_deg: 20, type: sample}", &resolved);
  EXPECT_EQ(resolved, "type: sample\nparticles: 64\nrange_deg: 20\n");
}

TEST(PluginLoader, NestedPluginsAreMadeAndReportedAtTheirPlace) {
  std::string resolved;
  const std::string text =
      "optimizer: {type: wrapper, inner: {type: wrapper, inner: {type: sample, particles: 5}}}";
  EXPECT_EQ(make(text, &resolved)->default_evaluations(), 20);
  EXPECT_EQ(resolved,
            "type: wrapper\n"
            "inner:\n"
            "  type: wrapper\n"
            "  inner:\n"
            "    type: sample\n"
            "    particles: 5\n"
            "    range_deg: 10\n"
            "  factor: 2\n"
            "factor: 2\n");
  EXPECT_EQ(ConfigNode::parse(resolved, "run.yaml").get("inner").get("inner").size(), 3u);
}

TEST(PluginLoader, ParametersOfPluginsAreReadStrictly) {
  EXPECT_EQ(config_error("optimizer:\n  type: sample\n  partikles: 5\n"),
            "scene.yaml:3:3: optimizer.partikles: unknown key; did you mean 'particles'? Allowed: "
            "particles, range_deg, type, weight");
  EXPECT_EQ(
      config_error("optimizer: {type: wrapper, inner: {type: sample, particles: 1}}"),
      "scene.yaml:1:61: optimizer.inner.particles: 1 is out of range; expected an integer from "
      "2 to 1000");
}

TEST(PluginLoader, TypeMustBeTheNameOfAPlugin) {
  EXPECT_EQ(config_error("optimizer: {particles: 5}"),
            "scene.yaml:1:12: optimizer.type: is missing; it names the optimizer to use");
  EXPECT_EQ(config_error("optimizer: {type: [sample]}"),
            "scene.yaml:1:19: optimizer.type: expected the name of the optimizer to use");
  EXPECT_EQ(config_error("optimizer: {type: }"),
            "scene.yaml:1:13: optimizer.type: expected the name of the optimizer to use");
  for (const std::string name : {"../sample", "/tmp/x", "Sample", "a-b", "a b", "''", "a.so"}) {
    EXPECT_THAT(
        config_error("optimizer: {type: " + name + "}"),
        AllOf(StartsWith("scene.yaml:1:19: optimizer.type: '"),
              EndsWith("' cannot be the name of a plugin; expected small letters, digits and "
                       "'_'")));
  }
}

TEST(PluginLoader, ConfigMustBeAMap) {
  EXPECT_EQ(
      config_error("optimizer: sample"),
      "scene.yaml:1:12: optimizer: is no map; expected a map with `type: NAME`, the optimizer "
      "to use");
  EXPECT_EQ(
      config_error("tracker: 1"),
      "scene.yaml:1:1: optimizer: is missing; expected a map with `type: NAME`, the optimizer "
      "to use");
}

TEST(PluginLoader, UnknownPluginListsNamesAndFolders) {
  EXPECT_THAT(
      plugin_error("smaple"),
      AllOf(StartsWith("scene.yaml:1:19: optimizer.type: there is no optimizer 'smaple'; did "
                       "you mean 'sample'? There are: "),
            HasSubstr("sample, "), HasSubstr("wrapper"),
            HasSubstr("Searched for libhypotrack_optimizer_smaple.so in " +
                      fixtures("good").string() + ", " + fixtures("bad").string() + ", ")));
  EXPECT_THAT(plugin_error("nothing_like_it"),
              HasSubstr("there is no optimizer 'nothing_like_it'; there are: "));
  PluginLoader loader({fixtures("good")});
  EXPECT_THAT(
      message_of<PluginError>([&] { loader.make<Source>(config("optimizer: {type: sample}")); }),
      HasSubstr("there is no source 'sample'"));
}

TEST(PluginLoader, FirstFolderWins) {
  const ConfigNode sample = config("optimizer: {type: sample}");
  PluginLoader good_first({fixtures("bad"), fixtures("good"), fixtures("other")});
  EXPECT_EQ(good_first.make<Optimizer>(sample)->default_evaluations(), 64);
  PluginLoader other_first({fixtures("bad"), fixtures("other"), fixtures("good")});
  EXPECT_THAT(message_of<PluginError>([&] { other_first.make<Optimizer>(sample); }),
              HasSubstr("its factory returned null"));
}

TEST(PluginLoader, LibrariesThatAreNoPluginsAreNamed) {
  EXPECT_EQ(plugin_error("not_elf"),
            fixture("bad", "not_elf").string() + ": cannot be loaded: invalid ELF header");
  EXPECT_THAT(plugin_error("unresolved"),
              AllOf(StartsWith(fixture("bad", "unresolved").string() + ": cannot be loaded: "),
                    HasSubstr("undefined symbol: function_that_nobody_has")));
  EXPECT_EQ(
      plugin_error("no_entry"),
      fixture("bad", "no_entry").string() +
          ": is no hypotrack plugin: it has no function hypotrack_plugin(); expected a library "
          "with one HYPOTRACK_PLUGIN(...)");
  EXPECT_EQ(plugin_error("null_descriptor"),
            fixture("bad", "null_descriptor").string() + ": hypotrack_plugin() returned null");
  EXPECT_THAT(
      plugin_error("throwing_entry"),
      EndsWith("hypotrack_plugin() threw an exception instead of returning its descriptor"));
  EXPECT_THAT(
      plugin_error("wrong_magic"),
      EndsWith(": is no hypotrack plugin: its descriptor begins with 'another\\x01plugin!!', "
               "expected 'hypotrack plugin'"));
}

TEST(PluginLoader, ALibraryThatWasCutOffAnywhereIsNamed) {
  const TemporaryDirectory folder;
  const auto whole = fixture("good", "sample");
  const auto cut = folder.path() / whole.filename();
  const auto size = std::filesystem::file_size(whole);
  for (int part = 0; part < 50; ++part) {
    std::filesystem::copy(whole, cut, std::filesystem::copy_options::overwrite_existing);
    const auto kept = part == 49 ? size - 1 : size * part / 49;
    std::filesystem::resize_file(cut, kept);
    PluginLoader loader({folder.path()});
    const std::string said = message_of<PluginError>(
        [&] { loader.make<Optimizer>(config("optimizer: {type: sample}")); });
    EXPECT_THAT(said, StartsWith(cut.string() + ": cannot be loaded: "));
    if (kept >= 64) {
      EXPECT_THAT(said, EndsWith("the file is cut off: it has " + std::to_string(kept) + " of " +
                                 std::to_string(size) + " bytes; build or copy it again"));
    }
  }
}

TEST(PluginLoader, MismatchesNameBothSides) {
  EXPECT_THAT(plugin_error("other_abi"),
              EndsWith(": was built for plugin ABI version " + std::to_string(kAbiVersion + 1) +
                       ", this hypotrack has " + std::to_string(kAbiVersion) +
                       "; build it again "
                       "with this hypotrack's headers"));
  EXPECT_THAT(plugin_error("short_descriptor"),
              EndsWith(": its descriptor has 40 bytes, this hypotrack needs " +
                       std::to_string(sizeof(HypotrackPlugin)) +
                       "; build it again with this hypotrack's headers"));
  EXPECT_THAT(plugin_error("other_tag"),
              AllOf(HasSubstr("the plugin has 'c++ 201703L, "), HasSubstr("eigen-align 64"),
                    HasSubstr("where this hypotrack has 'c++ 202002L, "),
                    HasSubstr("Plugin: 'c++ 201703L, cxxabi 1017, "),
                    HasSubstr(std::string("This hypotrack: '") + kBuildTag)));
  EXPECT_THAT(plugin_error("wrong_kind"),
              EndsWith(": says it is the objective 'wrong_kind', its file name says the optimizer "
                       "'wrong_kind'"));
  EXPECT_THAT(
      plugin_error("wrong_name"),
      EndsWith(": says it is the optimizer 'somebody_else', its file name says the optimizer "
               "'wrong_name'"));
  EXPECT_THAT(
      plugin_error("empty_members"),
      EndsWith(": its descriptor has empty members; fill it in with HYPOTRACK_PLUGIN(...)"));
}

TEST(PluginLoader, ARefusedLibraryIsRefusedAgain) {
  PluginLoader loader({fixtures("bad")});
  for (int i = 0; i < 2; ++i) {
    EXPECT_THROW(loader.make<Optimizer>(config("optimizer: {type: other_abi}")), PluginError);
  }
}

TEST(PluginLoader, NullFromTheFactoryIsAnError) {
  EXPECT_EQ(
      plugin_error("null_create"),
      "scene.yaml:1:12: optimizer 'null_create': could not be made: its factory returned null");
}

TEST(PluginLoader, ForeignExceptionsBecomePluginErrors) {
  const auto error = [](const std::string& what) {
    return message_of<PluginError>([&] { make("optimizer: {type: thrower, what: " + what + "}"); });
  };
  EXPECT_EQ(error("std"),
            "scene.yaml:1:12: optimizer 'thrower': could not be made: its constructor threw "
            "std::runtime_error: nothing works");
  EXPECT_THAT(error("bad_alloc"), EndsWith("its constructor threw std::bad_alloc: std::bad_alloc"));
  EXPECT_EQ(error("int"),
            "scene.yaml:1:12: optimizer 'thrower': could not be made: its constructor threw int, "
            "which is no std::exception");
}

TEST(PluginLoader, ErrorsOfHypotrackPassUnchanged) {
  EXPECT_EQ(config_error("optimizer: {type: thrower, what: config_error}"),
            "scene.yaml:1:12: says the plugin");
  EXPECT_EQ(message_of<DataError>([] { make("optimizer: {type: thrower, what: data_error}"); }),
            "file.png: says the plugin");
}

TEST(PluginLoader, AskingForAMissingSceneIsAnError) {
  EXPECT_EQ(message_of<PluginError>([] { make("optimizer: {type: thrower, what: scene}"); }),
            "scene.yaml:1:12: the plugin asks for the scene, which exists only once all models do");
}

TEST(PluginLoader, ObjectsOutliveTheirLoader) {
  std::unique_ptr<Optimizer> optimizer;
  {
    PluginLoader loader({fixtures("good")});
    optimizer = loader.make<Optimizer>(config("optimizer: {type: sample}"));
  }
  EXPECT_EQ(optimizer->default_evaluations(), 64);
}

}  // namespace
}  // namespace hypotrack::test
