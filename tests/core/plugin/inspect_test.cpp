#include "plugin/inspect.hpp"

#include <atomic>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "plugin_fixtures.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(Inspect, UsablePluginsAreDescribed) {
  const PluginRow row = check_plugin(fixture("good", "sample"));
  EXPECT_TRUE(row.usable()) << row.problem;
  EXPECT_EQ(row.path, fixture("good", "sample"));
  EXPECT_EQ(row.kind, "optimizer");
  EXPECT_EQ(row.name, "sample");
  EXPECT_EQ(row.version, "1.2.3");
  EXPECT_EQ(row.licence, "Apache-2.0");
  EXPECT_EQ(row.summary, "does what it is told");
  EXPECT_EQ(row.capabilities, "deterministic batch");
  EXPECT_THAT(row.parameters, HasSubstr("particles of the swarm"));
  EXPECT_THAT(format_check(row),
              testing::MatchesRegex(fixture("good", "sample").string() +
                                    ": optimizer 'sample' 1.2.3 can be used; it was built for "
                                    "hypotrack [0-9]+.[0-9]+, plugin ABI " +
                                    std::to_string(kAbiVersion) + "\n"));
}

TEST(Inspect, APluginForAnotherMinorVersionNamesIt) {
  std::ifstream sample(fixture("good", "sample"), std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(sample), std::istreambuf_iterator<char>()};
  const std::string library = "libhypotrack.so.";
  const std::size_t version = bytes.find(library) + library.size();
  const std::string ours = bytes.substr(version, bytes.find('\0', version) - version);
  bytes.replace(version, ours.size(), std::string(ours.size() - 2, '9') + ".9");
  const TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "libhypotrack_optimizer_sample.so";
  std::ofstream(file, std::ios::binary) << bytes;
  EXPECT_EQ(check_plugin(file).problem, "was built for hypotrack 9.9, this is " + ours +
                                            "; build it again with this hypotrack's headers");
}

TEST(Inspect, HarmIsARowNotTheEnd) {
  const auto problem = [](const std::string& name) {
    return check_plugin(fixture("harmful", name)).problem;
  };
  EXPECT_EQ(problem("segfault"), "crashed: SIGSEGV while loading");
  EXPECT_EQ(problem("abort"), "crashed: SIGABRT while loading");
  EXPECT_EQ(problem("throw"), "crashed: SIGABRT while loading");
  EXPECT_EQ(problem("exit"), "ended the program with exit code 3 while loading");
  EXPECT_EQ(check_plugin(fixture("bad", "crash_in_describe")).problem,
            "crashed: SIGSEGV while describing its parameters");
}

TEST(Inspect, HangingLibrariesAreKilled) {
  // Long enough to get as far as loading on a busy machine, if not always.
  const PluginRow row = check_plugin(fixture("harmful", "hang"), std::chrono::milliseconds(700));
  EXPECT_THAT(row.problem, StartsWith("hung: did not finish within 0.7 s while "));
}

TEST(Inspect, ProblemsReadLikeTheLoaders) {
  const auto problem = [](const std::string& name) {
    return check_plugin(fixture("bad", name)).problem;
  };
  EXPECT_THAT(problem("other_abi"),
              StartsWith("was built for plugin ABI version " + std::to_string(kAbiVersion + 1) +
                         ", this hypotrack has " + std::to_string(kAbiVersion) + ";"));
  EXPECT_THAT(problem("other_tag"), AllOf(HasSubstr("Plugin: 'c++ 201703L, "),
                                          HasSubstr("This hypotrack: 'c++ 202002L, ")));
  EXPECT_THAT(problem("no_entry"), StartsWith("is no hypotrack plugin: it has no function "));
  EXPECT_EQ(problem("not_elf"), "cannot be loaded: invalid ELF header");
  EXPECT_THAT(problem("unresolved"), HasSubstr("undefined symbol: function_that_nobody_has"));
}

TEST(Inspect, FilesThatAreNoPluginsAreSaidToBe) {
  EXPECT_EQ(check_plugin("/nowhere/libhypotrack_optimizer_x.so").problem, "there is no such file");
  EXPECT_EQ(check_plugin(fixtures("bad")).problem, "is no file");
  EXPECT_EQ(check_plugin(fixtures("bad") / "no_plugin_name.so").problem,
            "is not named like a plugin; expected libhypotrack_KIND_NAME.so");
}

TEST(Inspect, ListsEveryLibraryOnThePathOnce) {
  const std::vector<std::filesystem::path> path = {fixtures("other"), fixtures("good"), "/nowhere"};
  const auto rows = list_plugins(path);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].path, fixture("other", "sample"));
  EXPECT_TRUE(rows[0].usable()) << rows[0].problem;
  EXPECT_EQ(rows[1].path, fixture("good", "sample"));
  EXPECT_EQ(rows[1].problem, "hidden by " + fixture("other", "sample").string());
  EXPECT_EQ(rows[2].name, "thrower");
  EXPECT_EQ(rows[3].name, "wrapper");
}

TEST(Inspect, FindsByKindNameOrBoth) {
  const std::vector<std::filesystem::path> path = {fixtures("good")};
  EXPECT_EQ(find_plugins(path, "optimizer").size(), 3u);
  EXPECT_EQ(find_plugins(path, "sample").size(), 1u);
  EXPECT_EQ(find_plugins(path, "optimizer/sample").at(0).name, "sample");
  EXPECT_EQ(message_of<PluginError>([&] { find_plugins(path, "smaple"); }),
            "there is no plugin or kind of plugin 'smaple'; did you mean 'sample'? Searched in " +
                fixtures("good").string());
  EXPECT_EQ(
      message_of<PluginError>([&] { find_plugins(path, "source"); }),
      "there is no plugin or kind of plugin 'source'. Searched in " + fixtures("good").string());
}

TEST(Inspect, WorksWhileOtherThreadsAllocate) {
  std::atomic<bool> stop = false;
  std::thread busy([&] {
    while (!stop) {
      delete[] new char[1000];
      std::this_thread::yield();
    }
  });
  const PluginRow row = check_plugin(fixture("good", "wrapper"));
  stop = true;
  busy.join();
  EXPECT_TRUE(row.usable()) << row.problem;
}

PluginRow sample_row() {
  PluginRow row;
  row.path = "/p/libhypotrack_optimizer_pso.so";
  row.kind = "optimizer";
  row.name = "pso";
  row.version = "0.1.0";
  row.summary = "a swarm";
  row.licence = "MIT";
  row.parameters = "  particles  integer\n";
  return row;
}

TEST(Inspect, TableHasALinePerPlugin) {
  PluginRow broken = sample_row();
  broken.name = "broken_one";
  broken.problem = "crashed: SIGSEGV while loading";
  EXPECT_EQ(format_table(std::vector{sample_row(), broken}),
            "KIND       NAME        VERSION  LICENCE  SUMMARY\n"
            "optimizer  pso         0.1.0    MIT      a swarm\n"
            "optimizer  broken_one  -        -        UNUSABLE: crashed: SIGSEGV while loading\n"
            "2 plugins, 1 of them unusable\n");
}

TEST(Inspect, InfoEndsWithTheParameters) {
  EXPECT_EQ(format_info(sample_row()),
            "optimizer 'pso' 0.1.0: a swarm\n"
            "  licence       MIT\n"
            "  library       /p/libhypotrack_optimizer_pso.so\n"
            "capabilities: none\n"
            "parameters\n"
            "  particles  integer\n");
  PluginRow broken = sample_row();
  broken.problem = "crashed";
  EXPECT_EQ(format_info(broken),
            "optimizer 'pso' cannot be used: crashed\n"
            "  library       /p/libhypotrack_optimizer_pso.so\n");
  EXPECT_EQ(format_check(broken), "/p/libhypotrack_optimizer_pso.so: crashed\n");
}

TEST(Inspect, SaysWhatCapabilitiesMean) {
  PluginRow row = sample_row();
  row.capabilities = "seeded of_my_own";
  EXPECT_THAT(format_info(row),
              HasSubstr("capabilities\n"
                        "  seeded: takes random numbers; equal seeds repeat its answer\n"
                        "  of_my_own\n"));
}

TEST(Inspect, PagesLeaveOutWhatOnlySomeBuildsHave) {
  PluginRow row = sample_row();
  row.kind = "objective";
  row.capabilities = "device residuals";
  EXPECT_THAT(format_markdown(row),
              AllOf(HasSubstr("[Capabilities](index.md#capabilities): `residuals`.\n"),
                    Not(HasSubstr("device"))));
}

}  // namespace
}  // namespace hypotrack::test
