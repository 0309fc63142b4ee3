#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Programs whose folders are renamed or removed while they write.
class MovedFolderTest : public AppTest {
 protected:
  /// Starts a command that lasts until it is stopped.
  Start long_command(const std::string& command, const std::string& out) const {
    Start start;
    start.arguments = {command, scene(box_scene()),      "--out", path(out).string(),
                       "--set", "source.frames=1000000", "--set", "output.overlay=true"};
    return start;
  }
  template <class Condition>
  void wait_until(Program& program, const Condition& condition) const {
    while (program.running() && !condition())
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_TRUE(program.running()) << program.wait().err;
  }
  void wait_for_rows(Program& program, const std::string& table) const {
    wait_until(program, [&] { return rows(table) > 2; });
  }
  std::size_t rows(const std::string& table) const {
    const std::size_t lines = lines_of(read_text(path(table))).size();
    return lines > 0 ? lines - 1 : 0;
  }
  std::size_t frames(const std::string& summary) const {
    return nlohmann::json::parse(read_text(path(summary)))["frames"].get<std::size_t>();
  }
};

TEST_F(MovedFolderTest, ARunWritesIntoItsRenamedFolder) {
  Program program(long_command("run", "out"));
  wait_for_rows(program, "out/track.csv");
  std::filesystem::rename(path("out"), path("moved"));
  const Outcome other = run_program(
      {"run", path("scene.yaml").string(), "--out", path("out").string(), "--frames", "2"});
  EXPECT_EQ(other.exit_code, 0) << other.err;
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("results in " + path("moved").string() + "\n"));
  EXPECT_THAT(outcome.err, HasSubstr("was renamed: it is " + path("moved").string()));
  EXPECT_EQ(frames("moved/summary.json"), rows("moved/track.csv"));
  EXPECT_EQ(frames("out/summary.json"), 2u);
  EXPECT_EQ(rows("out/track.csv"), 2u);
  EXPECT_THAT(names_in(path("moved")), testing::Contains("overlay.mp4"));
}

TEST_F(MovedFolderTest, ARunWhoseFolderIsRemovedEndsAndSaysSo) {
  Program program(long_command("run", "out"));
  wait_for_rows(program, "out/track.csv");
  std::filesystem::rename(path("out"), path("moved"));
  std::filesystem::create_directory(path("out"));
  std::filesystem::remove_all(path("moved"));
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr(path("out").string() + ": this folder was removed"),
                                 Not(HasSubstr("/proc/")), Not(HasSubstr("frames so far"))));
  EXPECT_TRUE(std::filesystem::is_empty(path("out")));
}

TEST_F(MovedFolderTest, ARecordingFollowsTheFolderThatItIsIn) {
  std::filesystem::create_directory(path("a"));
  Program program(long_command("record", "a/recording"));
  wait_until(program, [&] { return names_in(path("a/.part.recording")).size() > 6; });
  const Outcome second = run_program(long_command("record", "a/recording"));
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_THAT(second.err, HasSubstr("another program is writing into it"));
  std::filesystem::rename(path("a"), path("b"));
  std::filesystem::create_directory(path("a"));
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_THAT(outcome.out, HasSubstr("recording in " + path("b/recording").string() + "\n"));
  EXPECT_TRUE(std::filesystem::exists(path("b/recording/scene.yaml")));
  EXPECT_TRUE(std::filesystem::is_empty(path("a")));
}

}  // namespace
}  // namespace hypotrack::test
