#include <sys/stat.h>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::IsEmpty;

/// `hypotrack get detector` with a program of the test's own in place of the network.
class GetTest : public AppTest {
 protected:
  /// Writes a program that is found before others of its name.
  void program(const std::string& name, const std::string& text) const {
    write_text(path("bin/" + name), "#!/bin/bash\n" + text + "\n");
    chmod(path("bin/" + name).c_str(), 0755);
  }

  Outcome get(const std::vector<std::string>& more = {}) const {
    program("npm", "exit 1");
    Start start;
    start.arguments = {"get", "detector", path("data/networks").string()};
    start.arguments.insert(start.arguments.end(), more.begin(), more.end());
    start.environment = {"PATH=" + path("bin").string() + ":/usr/bin:/bin"};
    return run_program(start);
  }

  void SetUp() override { std::filesystem::create_directories(path("bin")); }
};

TEST_F(GetTest, WithoutANetworkItSaysHowToGoOnAndLeavesNothing) {
  program("curl", "echo 'curl: (6) Could not resolve host\nMore details here: x' >&2; exit 6");
  expect_refusal(
      get(), {"https://registry.npmjs.org/@mediapipe/hands/-/hands-0.4.1675469240.tgz "
              "cannot be downloaded (curl: (6) Could not resolve host). Where there is no network,",
              "bring that file from another machine, and run: hypotrack get detector "
              "--archive hands-0.4.1675469240.tgz"});
  EXPECT_THAT(names_in(path("data")), IsEmpty());
}

TEST_F(GetTest, AnotherFileThanTheExpectedIsRefusedWithBothHashes) {
  write_text(path("hands.tgz"), "something else");
  expect_refusal(get({"--archive", path("hands.tgz").string()}),
                 {"hands.tgz is damaged: its sha256 is "
                  "f41f3fa625ff120ddca7ef456bf66371ecea23c129f4e4c32367101edb516cf8, expected "
                  "bdd5be939c60cbd72a49f4b6141407683cf2a67263598e1a44757d70b3dfcb8a"});
  program("curl", "while [ \"$1\" != --output ]; do shift; done; echo no >$2");
  expect_refusal(get(), {"hands-0.4.1675469240.tgz is damaged: its sha256 is "});
  EXPECT_THAT(names_in(path("data")), IsEmpty());
}

TEST_F(GetTest, AnArchiveThatIsNotThereIsNamed) {
  expect_refusal(get({"--archive", path("none.tgz").string()}),
                 {"there is no file " + path("none.tgz").string()});
}

TEST_F(GetTest, AFolderThatCannotBeMadeIsNamed) {
  write_text(path("data"), "a file");
  expect_refusal(get(), {"cannot make the folder " + path("data").string()});
  std::filesystem::remove(path("data"));
  expect_refusal(run_program({"get", "detector", "/proc/data/networks"}),
                 {"cannot make the folder /proc/data"});
}

}  // namespace
}  // namespace hypotrack::test
