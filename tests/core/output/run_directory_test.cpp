#include "output/run_directory.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "base/text_file.hpp"
#include "expect_error.hpp"
#include "hypotrack/error.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using std::filesystem::exists;

TEST(RunDirectory, FilesGetTheirNamesAllTogether) {
  const test::TemporaryDirectory folder;
  RunDirectory directory(folder.path() / "new" / "out", {"a.csv", "b.csv"});
  TextFile(directory.part("a.csv")).write("a");
  TextFile(directory.part("b.csv")).write("b");
  EXPECT_FALSE(exists(directory.path() / "a.csv"));
  directory.finish();
  EXPECT_TRUE(exists(directory.path() / "a.csv"));
  EXPECT_TRUE(exists(directory.path() / "b.csv"));
  EXPECT_FALSE(exists(directory.path() / ".part.a.csv"));
}

TEST(RunDirectory, NoFileGetsItsNameWhenOneWasNeverWritten) {
  const test::TemporaryDirectory folder;
  std::ofstream(folder.path() / "a.csv") << "old";
  RunDirectory directory(folder.path(), {"a.csv", "b.csv"});
  TextFile(directory.part("a.csv")).write("new");
  directory.part("b.csv");
  EXPECT_THAT(test::message_of<OutputError>([&] { directory.finish(); }),
              ::testing::HasSubstr(".part.b.csv: was never written"));
  EXPECT_TRUE(exists(folder.path() / ".part.a.csv"));
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "a.csv"), 3U);
}

TEST(RunDirectory, WithoutAnythingToKeepNothingStays) {
  const test::TemporaryDirectory folder;
  {
    RunDirectory directory(folder.path() / "out", {"a.csv"});
    TextFile(directory.part("a.csv")).write("a");
  }
  EXPECT_FALSE(exists(folder.path() / "out"));
}

TEST(RunDirectory, WhatIsWorthKeepingStaysUnderItsUnfinishedName) {
  const test::TemporaryDirectory folder;
  {
    RunDirectory directory(folder.path(), {"a.csv"});
    TextFile(directory.part("a.csv")).write("a");
    directory.keep();
  }
  EXPECT_TRUE(exists(folder.path() / ".part.a.csv"));
}

TEST(RunDirectory, RemovesOldResultsAndOldUnfinishedFilesButNothingElse) {
  const test::TemporaryDirectory folder;
  for (const char* name : {"a.csv", "b.csv", ".part.b.csv", ".part.mine", "mine"})
    std::ofstream(folder.path() / name) << "old";
  RunDirectory directory(folder.path(), {"a.csv", "b.csv"});
  EXPECT_FALSE(exists(folder.path() / ".part.b.csv"));
  EXPECT_TRUE(exists(folder.path() / "b.csv"));  // until there is something better
  TextFile(directory.part("a.csv")).write("new");
  directory.finish();
  EXPECT_FALSE(exists(folder.path() / "b.csv"));
  EXPECT_TRUE(exists(folder.path() / "mine"));
  EXPECT_TRUE(exists(folder.path() / ".part.mine"));
}

TEST(RunDirectory, FilesOfOthersWithTheNamesOfResultsAreRefusedAndStay) {
  const test::TemporaryDirectory folder;
  const std::vector<std::string> results{"run.yaml", "a.csv", "b.csv"};
  std::ofstream(folder.path() / "b.csv") << "mine";
  EXPECT_THAT(
      test::message_of<OutputError>([&] { RunDirectory(folder.path(), results); }),
      testing::AllOf(testing::HasSubstr((folder.path() / "b.csv").string()),
                     testing::HasSubstr("no run.yaml beside it"), testing::HasSubstr("--out")));
  EXPECT_TRUE(exists(folder.path() / "b.csv"));
  std::ofstream(folder.path() / ".part.run.yaml") << "of a run that was killed at its end";
  RunDirectory(folder.path(), results);
}

TEST(RunDirectory, AHashInAResultStandsForAnyNumber) {
  const test::TemporaryDirectory folder;
  for (const char* name : {"worst_7.jpg", "worst_case.jpg", "worst_.jpg", ".part.worst_12.jpg"})
    std::ofstream(folder.path() / name) << "old";
  RunDirectory directory(folder.path(), {"worst_#.jpg"});
  EXPECT_FALSE(exists(folder.path() / ".part.worst_12.jpg"));
  TextFile(directory.part("worst_30.jpg")).write("new");
  directory.finish();
  EXPECT_FALSE(exists(folder.path() / "worst_7.jpg"));
  EXPECT_TRUE(exists(folder.path() / "worst_30.jpg"));
  EXPECT_TRUE(exists(folder.path() / "worst_case.jpg"));
  EXPECT_TRUE(exists(folder.path() / "worst_.jpg"));
}

TEST(RunDirectory, ASecondRunIsKeptOutUntilTheFirstEnds) {
  const test::TemporaryDirectory folder;
  {
    RunDirectory first(folder.path(), {"a.csv"});
    TextFile(first.part("a.csv")).write("first");
    EXPECT_THAT(test::message_of<OutputError>([&] { RunDirectory(folder.path(), {"a.csv"}); }),
                testing::AllOf(testing::HasSubstr(folder.path().string()),
                               testing::HasSubstr("another run"), testing::HasSubstr("--out")));
    EXPECT_TRUE(exists(folder.path() / ".part.a.csv"));
    first.finish();
  }
  RunDirectory(folder.path(), {"a.csv"});
}

TEST(RunDirectory, AFolderWithTheNameOfANumberedResultIsRefused) {
  const test::TemporaryDirectory folder;
  std::filesystem::create_directory(folder.path() / "worst_7.jpg");
  EXPECT_THAT(test::message_of<OutputError>([&] { RunDirectory(folder.path(), {"worst_#.jpg"}); }),
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

}  // namespace
}  // namespace hypotrack
