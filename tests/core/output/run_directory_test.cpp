#include "output/run_directory.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "base/text_file.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using std::filesystem::exists;

class RunDirectoryTest : public testing::Test {
 protected:
  std::filesystem::path path() const { return folder_.path() / "out"; }
  std::filesystem::path path(const std::string& name) const { return path() / name; }
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(path(name).parent_path());
    std::ofstream(path(name)) << text;
  }
  std::string text(const std::string& name) const {
    std::stringstream text;
    text << std::ifstream(path(name)).rdbuf();
    return text.str();
  }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path()))
      names.push_back(entry.path().filename().string());
    return names;
  }
  /// Leaves what a run leaves that is killed before it calls finish().
  void killed_run(const std::string& text) const {
    RunDirectory directory(path(), results_);
    for (const char* name : {"run.yaml", "a.csv"}) TextFile(directory.file(name)).write(text);
    directory.keep();
  }
  void whole_run(const std::string& text) const {
    RunDirectory directory(path(), results_);
    for (const std::string& name : results_) TextFile(directory.file(name)).write(text);
    directory.finish();
  }

  const test::TemporaryDirectory folder_;
  const std::vector<std::string> results_{"run.yaml", "a.csv", "b.csv", "summary.json"};
};

TEST_F(RunDirectoryTest, FilesGrowUnderTheirNamesAndTheLastAppearsAtTheEnd) {
  RunDirectory directory(path("new"), results_);
  for (const std::string& name : results_) TextFile(directory.file(name)).write(name);
  EXPECT_EQ(text("new/a.csv"), "a.csv");
  EXPECT_FALSE(exists(path("new/summary.json")));
  directory.finish();
  EXPECT_EQ(text("new/summary.json"), "summary.json");
  EXPECT_FALSE(exists(path("new/.part.summary.json")));
}

TEST_F(RunDirectoryTest, IsNotFinishedWhenAFileWasNeverWritten) {
  whole_run("old");
  RunDirectory directory(path(), results_);
  TextFile(directory.file("summary.json")).write("new");
  directory.file("b.csv");
  EXPECT_THAT(test::message_of<OutputError>([&] { directory.finish(); }),
              testing::HasSubstr("b.csv: was never written"));
  EXPECT_FALSE(exists(path("summary.json")));
  EXPECT_EQ(text(".previous/summary.json"), "old");
}

TEST_F(RunDirectoryTest, WithoutAnythingToKeepNothingStays) {
  {
    RunDirectory directory(path(), results_);
    TextFile(directory.file("a.csv")).write("a");
  }
  EXPECT_FALSE(exists(path()));
}

TEST_F(RunDirectoryTest, WithoutAnythingToKeepTheEarlierResultIsBack) {
  whole_run("old");
  {
    RunDirectory directory(path(), results_);
    TextFile(directory.file("a.csv")).write("new");
  }
  EXPECT_THAT(names(), testing::UnorderedElementsAreArray(results_));
  EXPECT_EQ(text("a.csv"), "old");
}

TEST_F(RunDirectoryTest, WhatIsWorthKeepingStays) {
  killed_run("new");
  EXPECT_EQ(text("a.csv"), "new");
  EXPECT_FALSE(exists(path("summary.json")));
}

TEST_F(RunDirectoryTest, TheEarlierResultStaysAsideUntilARunEnds) {
  whole_run("old");
  killed_run("killed");
  EXPECT_EQ(text("a.csv"), "killed");
  killed_run("killed again");
  EXPECT_EQ(text("a.csv"), "killed again");
  for (const std::string& name : results_) EXPECT_EQ(text(".previous/" + name), "old") << name;
  whole_run("new");
  EXPECT_THAT(names(), testing::UnorderedElementsAreArray(results_));
  EXPECT_EQ(text("a.csv"), "new");
}

TEST_F(RunDirectoryTest, AKillWhileTheEarlierResultIsMovedLosesNothing) {
  whole_run("old");
  for (const char* name : {"summary.json", "run.yaml"}) {  // killed half-way
    std::filesystem::create_directory(path(".previous.moving"));
    std::filesystem::rename(path(name), path(".previous.moving") / name);
  }
  killed_run("killed");
  for (const std::string& name : results_) EXPECT_EQ(text(".previous/" + name), "old") << name;
}

TEST_F(RunDirectoryTest, AKillBeforeTheEarlierResultIsRemovedLosesNothing) {
  whole_run("new");
  write(".previous/a.csv", "old");
  { RunDirectory directory(path(), results_); }
  EXPECT_EQ(text("a.csv"), "new");
  EXPECT_THAT(names(), testing::UnorderedElementsAreArray(results_));
}

TEST_F(RunDirectoryTest, RemovesOldResultsAndNothingElse) {
  whole_run("old");
  write("mine", "mine");
  {
    RunDirectory directory(path(), results_);
    for (const char* name : {"run.yaml", "summary.json"})
      TextFile(directory.file(name)).write("new");
    directory.finish();
  }
  EXPECT_THAT(names(), testing::UnorderedElementsAre("run.yaml", "summary.json", "mine"));
}

TEST_F(RunDirectoryTest, AResultOfAnOutputThatTheNextRunLacksStays) {
  { RunDirectory(path(), results_); }
  write("run.yaml", "old");
  write("c.csv", "old");
  write(".previous.moving/a.csv", "old");
  write(".previous.moving/d.csv", "old");
  { RunDirectory directory(path(), results_); }
  EXPECT_THAT(names(), testing::UnorderedElementsAre("run.yaml", "a.csv", "c.csv", "d.csv"));
}

TEST(RunDirectory, FilesOfOthersWithTheNamesOfResultsAreRefusedAndStay) {
  const test::TemporaryDirectory folder;
  const std::vector<std::string> results{"run.yaml", "a.csv", "b.csv", "summary.json"};
  std::ofstream(folder.path() / "b.csv") << "mine";
  EXPECT_THAT(
      test::message_of<OutputError>([&] { RunDirectory(folder.path(), results); }),
      testing::AllOf(testing::HasSubstr((folder.path() / "b.csv").string()),
                     testing::HasSubstr("no run.yaml beside it"), testing::HasSubstr("--out")));
  EXPECT_TRUE(exists(folder.path() / "b.csv"));
  std::filesystem::create_directory(folder.path() / ".previous.moving");
  std::ofstream(folder.path() / ".previous.moving/run.yaml") << "of a run that was killed";
  RunDirectory(folder.path(), results);
}

TEST_F(RunDirectoryTest, AHashInAResultStandsForAnyNumber) {
  for (const char* name : {"run.yaml", "worst_7.jpg", "worst_case.jpg", "worst_.jpg"})
    write(name, "old");
  RunDirectory directory(path(), {"run.yaml", "worst_#.jpg", "summary.json"});
  for (const char* name : {"run.yaml", "worst_30.jpg", "summary.json"})
    TextFile(directory.file(name)).write("new");
  directory.finish();
  EXPECT_THAT(names(), testing::UnorderedElementsAre("run.yaml", "worst_30.jpg", "worst_case.jpg",
                                                     "worst_.jpg", "summary.json"));
}

TEST_F(RunDirectoryTest, ASecondRunIsKeptOutUntilTheFirstEnds) {
  {
    RunDirectory first(path(), results_);
    for (const std::string& name : results_) TextFile(first.file(name)).write("first");
    EXPECT_THAT(test::message_of<OutputError>([&] { RunDirectory(path(), results_); }),
                testing::AllOf(testing::HasSubstr(path().string()),
                               testing::HasSubstr("another run"), testing::HasSubstr("--out")));
    EXPECT_EQ(text("a.csv"), "first");
    first.finish();
  }
  RunDirectory(path(), results_);
}

TEST(RunDirectory, AFolderWithTheNameOfANumberedResultIsRefused) {
  const test::TemporaryDirectory folder;
  std::filesystem::create_directory(folder.path() / "worst_7.jpg");
  EXPECT_THAT(test::message_of<OutputError>([&] {
                RunDirectory(folder.path(), {"worst_#.jpg", "b"});
              }),
              testing::HasSubstr("worst_7.jpg: is a folder"));
}

TEST(TextFile, ADiskThatIsFullIsReported) {
  if (!exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  TextFile file("/dev/full");
  try {
    file.write("line\n");
    FAIL() << "nothing was thrown";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("/dev/full: cannot be written: No space left"));
    EXPECT_THAT(error.what(), testing::HasSubstr("Make room"));
  }
}

TEST(TextFile, ALineThatDoesNotFitIsNotLeftInPart) {
  const test::TemporaryDirectory folder;
  const auto path = folder.path() / "a.csv";
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto ignore = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 8;
  TextFile file(path);
  file.write("12345\n");
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string message = test::message_of<OutputError>([&] { file.write("67890\n"); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, ignore);
  EXPECT_THAT(message, testing::HasSubstr("File too large"));
  EXPECT_EQ(std::filesystem::file_size(path), 6U);
  file.write("67890\n");
  EXPECT_EQ(std::filesystem::file_size(path), 12U);
}

TEST_F(RunDirectoryTest, ARenamedFolderGetsAllItsFilesAndTheOtherNone) {
  RunDirectory first(path("one"), results_);
  TextFile(first.file("run.yaml")).write("first");
  std::filesystem::rename(path("one"), path("moved"));
  RunDirectory second(path("one"), results_);
  for (const std::string& name : results_) {
    if (name != "run.yaml") TextFile(first.file(name)).write("first");
    TextFile(second.file(name)).write("second");
  }
  first.finish();
  EXPECT_FALSE(exists(path("one/summary.json")));
  second.finish();
  for (const std::string& name : results_) {
    EXPECT_EQ(text("moved/" + name), "first") << name;
    EXPECT_EQ(text("one/" + name), "second") << name;
  }
}

TEST_F(RunDirectoryTest, ARemovedFolderIsSaid) {
  RunDirectory directory(path("one"), results_);
  for (const std::string& name : results_) TextFile(directory.file(name)).write("text");
  std::filesystem::remove_all(path("one"));
  EXPECT_THAT(
      test::message_of<OutputError>([&] { directory.finish(); }),
      testing::AllOf(testing::StartsWith(path("one").string()), testing::HasSubstr("was removed")));
}

TEST_F(RunDirectoryTest, NothingToKeepRemovesTheRenamedFolderOnly) {
  {
    RunDirectory directory(path("one"), results_);
    TextFile(directory.file("a.csv")).write("text");
    std::filesystem::rename(path("one"), path("moved"));
    std::filesystem::create_directory(path("one"));
  }
  EXPECT_TRUE(exists(path("one")));
  EXPECT_FALSE(exists(path("moved")));
}

}  // namespace
}  // namespace hypotrack
