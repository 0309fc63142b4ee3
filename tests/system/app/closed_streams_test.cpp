#include "app_test.hpp"

namespace hypotrack::test {
namespace {

class ClosedStreamsTest : public AppTest {
 protected:
  /// Runs the program as a shell that closes streams does (`>&- 2>&-`). Returns its exit code.
  static int run_without(const std::string& streams, const std::vector<std::string>& arguments) {
    Subprocess::Command command{
        "/bin/sh", {"-c", "exec \"$@\" " + streams, "sh", build_dir() / "bin" / "hypotrack"}};
    command.arguments.insert(command.arguments.end(), arguments.begin(), arguments.end());
    return Subprocess(command).wait().code;
  }
};

TEST_F(ClosedStreamsTest, ARunWithoutStandardStreamsWritesTheSameTables) {
  const Outcome ordinary = run(box_scene());
  ASSERT_EQ(ordinary.exit_code, 0) << ordinary.err;
  for (const char* streams : {">&-", "2>&-", ">&- 2>&-", "<&- >&- 2>&-"}) {
    SCOPED_TRACE(streams);
    const std::filesystem::path out = path("without");
    EXPECT_EQ(run_without(streams, {"run", path("scene.yaml").string(), "--frames", "5", "--out",
                                    out.string()}),
              0);
    EXPECT_EQ(track_without_times(out), track_without_times(path("out")));
    for (const char* table : {"joints.csv", "errors.csv"})
      EXPECT_EQ(read_text(out / table), read_text(path("out") / table)) << table;
    std::filesystem::remove_all(out);
  }
}

TEST_F(ClosedStreamsTest, WhatIsPrintedLandsInNoFile) {
  const std::string file = scene(box_scene());
  EXPECT_EQ(run_without(">&- 2>&-", {"run", file, "--out", path("out").string()}), 0);
  for (const std::string& name : names_in(path("out")))
    for (const char* text : {"tracking with", "results in", "by the clock"})
      EXPECT_THAT(read_text(path("out") / name), testing::Not(testing::HasSubstr(text))) << name;
}

}  // namespace
}  // namespace hypotrack::test
