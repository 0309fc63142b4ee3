#include <csignal>
#include <map>

#include "compare_test.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class CompareRestartTest : public CompareTest {
 protected:
  /// Whether any process still works below a folder: its open files lie there.
  bool anybody_works_in(const std::filesystem::path& folder) const {
    for (const auto& process : std::filesystem::directory_iterator("/proc")) {
      std::error_code error;
      for (const auto& file : std::filesystem::directory_iterator(process.path() / "fd", error)) {
        const auto target = std::filesystem::read_symlink(file.path(), error);
        if (target.string().starts_with(folder.string())) return true;
      }
    }
    return false;
  }

  void wait_until_nobody_works_in(const std::filesystem::path& folder) const {
    for (int i = 0; i < 2000 && anybody_works_in(folder); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_FALSE(anybody_works_in(folder));
  }

  /// The small study with more seeds, so that it can be caught in the middle.
  static std::string longer_study() { return replaced(study(), "seeds: 2", "seeds: 6"); }

  void expect_same_tables(const std::string& a, const std::string& b) const {
    EXPECT_EQ(table("results.csv", a), table("results.csv", b));
    EXPECT_EQ(table("cells.csv", a), table("cells.csv", b));
  }

  /// When each finished run was made.
  std::map<std::string, std::filesystem::file_time_type> times(const std::string& out) const {
    std::map<std::string, std::filesystem::file_time_type> times;
    for (const std::string& name : run_names(out))
      times[name] = std::filesystem::last_write_time(path(out) / "runs" / name / "timing.json");
    return times;
  }
};

TEST_F(CompareRestartTest, CtrlCGivesUpWhatIsBeingMade) {
  Program program(start(long_study(), "out", {"--jobs", "2"}));
  wait_for_work(program, "out", 2);
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("the same command goes on from here"));
  EXPECT_THAT(names_in(path("out/.working")), IsEmpty());
  EXPECT_THAT(run_names(), IsEmpty());
  EXPECT_FALSE(anybody_works_in(path("out")));
}

TEST_F(CompareRestartTest, RunsDieWithAKilledStudyAndTheNextCleansUp) {
  {
    Program program(start(long_study(), "out", {"--jobs", "2"}));
    wait_for_work(program, "out", 2);
    program.signal(SIGKILL);
    EXPECT_EQ(program.wait().exit_code, 128 + SIGKILL);
  }
  wait_until_nobody_works_in(path("out"));
  EXPECT_THAT(names_in(path("out/.working")), SizeIs(4));  // two runs and their locks
  // Only one run at a time now: the rest of what was left goes all the same.
  Program program(start(long_study(), "out", {"--jobs", "1"}));
  while (program.running() && names_in(path("out/.working")).size() != 2)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_TRUE(program.running());
}

TEST_F(CompareRestartTest, AKilledStudyGoesOnWhereItWasAndEndsTheSame) {
  ASSERT_EQ(compare(longer_study(), "whole").exit_code, 0);
  {
    Program program(start(longer_study(), "out"));
    while (program.running() && run_names().size() < 3)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    program.signal(SIGKILL);
    ASSERT_EQ(program.wait().exit_code, 128 + SIGKILL);
  }
  wait_until_nobody_works_in(path("out"));
  const auto before = times("out");
  EXPECT_LT(before.size(), 12U);
  const Outcome rest = compare(longer_study());
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_THAT(rest.err, HasSubstr(std::to_string(12 - before.size()) + " to make here"));
  expect_same_tables("out", "whole");
  const auto after = times("out");
  for (const auto& [name, time] : before) EXPECT_EQ(after.at(name), time) << name;
}

TEST_F(CompareRestartTest, ShardsTogetherMakeTheTablesOfOneRun) {
  ASSERT_EQ(compare(longer_study(), "whole").exit_code, 0);
  const Start one = start(longer_study(), "out", {"--shard", "1/3", "--jobs", "1"});
  const Start two = start(longer_study(), "out", {"--shard", "2/3", "--jobs", "1"});
  const Start three = start(longer_study(), "out", {"--shard", "3/3", "--jobs", "1"});
  Program first(one), second(two), third(three);
  for (Program* program : {&first, &second, &third}) {
    const Outcome outcome = program->wait();
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("4 to make here"));
  }
  expect_same_tables("out", "whole");
}

TEST_F(CompareRestartTest, TwoProcessesOnOneFolderShareTheWork) {
  ASSERT_EQ(compare(longer_study(), "whole").exit_code, 0);
  const Start both = start(longer_study(), "out", {"--jobs", "2"});
  Program first(both), second(both);
  for (Program* program : {&first, &second}) {
    const Outcome outcome = program->wait();
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("12 of 12 runs are there, 0 failed"));
  }
  expect_same_tables("out", "whole");
}

}  // namespace
}  // namespace hypotrack::test
