#include "lab/study/study_folder.hpp"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "study_test.hpp"

namespace hypotrack::test {
namespace {

using study::Plan;
using study::RunState;
using study::StudyFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class StudyFolderTest : public StudyTest {
 protected:
  std::string complaint(const Plan& plan) const {
    return message_of<OutputError>([&] { StudyFolder(path("out"), plan); });
  }

  std::vector<std::string> names(const std::string& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path(folder)))
      names.push_back(entry.path().filename().string());
    return names;
  }

  Plan changed(const std::string& piece, const std::string& by) const {
    std::string text = small_study();
    return plan(text.replace(text.find(piece), piece.size(), by));
  }

  Plan plan_ = plan(small_study());
};

TEST_F(StudyFolderTest, ARunAppearsWhenAllOfItIsThere) {
  const StudyFolder folder(path("out"), plan_);
  folder.begin();
  const study::PlannedRun& run = plan_.runs[0];
  {
    auto claimed = folder.claim(run);
    ASSERT_TRUE(claimed.has_value());
    std::ofstream(claimed->working() / "track.csv") << "frame\n";
    std::ofstream(claimed->log()) << "progress\n";
    EXPECT_EQ(folder.state(run), RunState::missing);
    claimed->finish(plan_, run, {2.5, 1});
  }
  EXPECT_EQ(folder.state(run), RunState::ok);
  EXPECT_THAT(names("out/runs/" + run.id),
              testing::UnorderedElementsAre("track.csv", "cell.json", "timing.json"));
  EXPECT_THAT(names("out/.working"), IsEmpty());
  EXPECT_THAT(read(folder.run_path(run) / "cell.json"),
              AllOf(HasSubstr("\"scene\": \"box\""), HasSubstr("\"optimizer.particles\": 8"),
                    HasSubstr("\"method\": \"pso\""), HasSubstr("\"seed\": 1")));
}

TEST_F(StudyFolderTest, ARunThatIsGivenUpLeavesNothing) {
  const StudyFolder folder(path("out"), plan_);
  folder.begin();
  std::ofstream(folder.claim(plan_.runs[0])->working() / "track.csv") << "frame\n";
  EXPECT_EQ(folder.state(plan_.runs[0]), RunState::missing);
  EXPECT_THAT(names("out/.working"), IsEmpty());
  EXPECT_THAT(names("out/runs"), IsEmpty());
}

TEST_F(StudyFolderTest, AFailureIsANoteWithTheLogAndCanBeTriedAgain) {
  const StudyFolder folder(path("out"), plan_);
  folder.begin();
  const study::PlannedRun& run = plan_.runs[0];
  {
    auto claimed = folder.claim(run);
    std::ofstream(claimed->working() / "track.csv") << "frame\n";
    std::ofstream(claimed->log()) << "hypotrack: broken\n";
    const std::string where = claimed->working().string();
    claimed->fail(plan_, run, {where + "/track.csv: broken", 1});
  }
  EXPECT_EQ(folder.state(run), RunState::failed);
  EXPECT_THAT(names("out/runs/" + run.id),
              testing::UnorderedElementsAre("cell.json", "failure.json", "log.txt"));
  EXPECT_THAT(read(folder.run_path(run) / "failure.json"),
              HasSubstr("\"the run's folder/track.csv: broken\""));
  folder.claim(run)->finish(plan_, run, {1, 1});
  EXPECT_EQ(folder.state(run), RunState::ok);
}

TEST_F(StudyFolderTest, TwoClaimsOfOneRunExcludeEachOther) {
  const StudyFolder folder(path("out"), plan_);
  const StudyFolder same(path("out"), plan_);
  folder.begin();
  auto claimed = folder.claim(plan_.runs[0]);
  ASSERT_TRUE(claimed.has_value());
  std::ofstream(claimed->working() / "track.csv") << "frame\n";
  EXPECT_FALSE(same.claim(plan_.runs[0]).has_value());
  EXPECT_TRUE(same.claim(plan_.runs[1]).has_value());
  same.begin();  // cleans up, but not what somebody works on
  EXPECT_TRUE(std::filesystem::exists(claimed->working() / "track.csv"));
}

TEST_F(StudyFolderTest, WhatAKilledProcessLeftIsCleanedUp) {
  const StudyFolder folder(path("out"), plan_);
  folder.begin();
  const pid_t child = fork();
  if (child == 0) {
    auto claimed = folder.claim(plan_.runs[0]);
    std::ofstream(claimed->working() / "track.csv") << "frame\n";
    kill(getpid(), SIGKILL);
  }
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  EXPECT_THAT(names("out/.working"), testing::SizeIs(2));
  folder.begin();
  EXPECT_THAT(names("out/.working"), IsEmpty());
  EXPECT_TRUE(folder.claim(plan_.runs[0]).has_value());
}

TEST_F(StudyFolderTest, AStudyMayGrowInItsFolder) {
  StudyFolder(path("out"), plan_).begin();
  const Plan more = changed("seeds: 2", "seeds: 3");
  const StudyFolder folder(path("out"), more);
  EXPECT_FALSE(folder.begun());
  folder.begin();
  EXPECT_TRUE(folder.begun());
  EXPECT_THAT(read(path("out/study.yaml")), HasSubstr("seeds: [1, 2, 3]"));
}

TEST_F(StudyFolderTest, AnotherStudyIsRefusedAndTheDifferenceNamed) {
  StudyFolder(path("out"), plan_).begin();
  EXPECT_THAT(complaint(changed("seeds: 2\nframes: 5", "seeds: 1\nframes: 4")),
              AllOf(HasSubstr("holds another study: 16 of its 16 runs"),
                    HasSubstr("they differ in: seeds, frames")));
  write("box.yaml", "models: [another]\n");
  EXPECT_THAT(complaint(plan(small_study())),
              AllOf(HasSubstr("8 of its 16 runs"), HasSubstr("the content of its scene files")));
}

TEST_F(StudyFolderTest, AFolderThatIsNoStudysIsRefused) {
  std::filesystem::create_directory(path("out"));
  std::ofstream(path("out/thesis.tex")) << "a year's work";
  EXPECT_THAT(complaint(plan_), HasSubstr("is not empty and holds no study"));
  EXPECT_THAT(message_of<OutputError>([&] { StudyFolder(path("box.yaml"), plan_); }),
              HasSubstr("is a file; name a folder"));
}

TEST_F(StudyFolderTest, AStudyOfOneRecordingIsNotContinuedWithRedrawnNoise) {
  write("box.yaml", "models: []\nsource: {type: synthetic}\n");
  const Plan once = plan(small_study() + "redraw: nothing\n");
  StudyFolder(path("out"), once).begin();
  std::string before = read(path("out/study.yaml"));
  before.erase(before.find("redraw: nothing\n"), 16);  // of a program without the key
  write("out/study.yaml", before);
  EXPECT_NO_THROW(StudyFolder(path("out"), once));
  EXPECT_THAT(complaint(plan(small_study())),
              AllOf(HasSubstr("4 of its 16 runs are not part of this one"),
                    HasSubstr("they differ in: redraw (the folder's is nothing)")));
}

}  // namespace
}  // namespace hypotrack::test
