#include "lab/study/results.hpp"

#include <gmock/gmock.h>

#include "hypotrack/api/error.hpp"
#include "lab/study/study_folder.hpp"
#include "study_test.hpp"

namespace hypotrack::test {
namespace {

/// A study of one scene and two cells, whose runs are written by hand.
class TablesTest : public StudyTest {
 protected:
  void SetUp() override { std::filesystem::create_directories(path("out/.working")); }

  void add_run(std::size_t run, const std::string& metrics) const {
    const auto folder = run_folder(run);
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "metrics.json") << metrics;
    std::ofstream(folder / "summary.json")
        << R"({"complete": true, "frames": 5, "fps": 20.5, "search_fps": 8.5,
      "evaluations_per_second": 1000, "lost_frames": 1, "backend": "cpu"})";
    std::ofstream(folder / "timing.json") << R"({"seconds": 1.5, "threads": 2, "gpu": 1})";
  }

  void add_failure(std::size_t run, const std::string& message) const {
    std::filesystem::create_directories(run_folder(run));
    std::ofstream(run_folder(run) / "failure.json")
        << R"({"message": ")" << message << R"(", "exit_code": 1})";
  }

  study::Tally write_tables() const {
    return study::write_tables(study::StudyFolder(path("out"), plan_), plan_);
  }

  std::string table(const std::string& name) const { return read(path("out") / name); }

  std::filesystem::path run_folder(std::size_t run) const {
    return path("out/runs") / plan_.runs[run].id;
  }
  // In the order of the plan: (16, seed 1), (8, seed 1), (16, seed 2), (8, seed 2).
  study::Plan plan_ = plan(
      "title: t\nscenes: {box: {file: box.yaml}}\ngrid: {optimizer.particles: [16, 8]}\nseeds: 2");
};

TEST_F(TablesTest, AreSortedBySceneAxesAndSeedWhateverTheOrderOfTheRuns) {
  add_run(3, R"({"frames": 5, "mean_error_mm": 4, "time_to_loss_s": 0.1, "models": {"box": 4}})");
  add_run(1, R"({"frames": 5, "mean_error_mm": 2, "time_to_loss_s": null})");
  add_run(2, R"({"frames": 5, "mean_error_mm": 0.125, "time_to_loss_s": null})");
  add_failure(0, "no, \\\"never\\\"\\nagain");
  const study::Tally tally = write_tables();
  EXPECT_EQ(tally.planned, 4U);
  EXPECT_EQ(tally.ok, 3U);
  EXPECT_EQ(tally.failed, 1U);
  EXPECT_EQ(table("results.csv"),
            "scene,optimizer.particles,seed,status,message,frames,mean_error_mm,time_to_loss_s\n"
            "box,16,1,failed,\"no, \"\"never\"\" again\",,,\n"
            "box,16,2,ok,,5,0.125,\n"
            "box,8,1,ok,,5,2,\n"
            "box,8,2,ok,,5,4,0.1\n");
}

TEST_F(TablesTest, CellsHoldMeanAndDeviationOverTheSeedsThatHaveANumber) {
  add_run(1, R"({"mean_error_mm": 2, "time_to_loss_s": null})");
  add_run(3, R"({"mean_error_mm": 4, "time_to_loss_s": 0.5})");
  add_failure(0, "broken");
  write_tables();
  EXPECT_EQ(table("cells.csv"),
            "scene,optimizer.particles,runs,failed,mean_error_mm_mean,mean_error_mm_sd,"
            "time_to_loss_s_mean,time_to_loss_s_sd\n"
            "box,16,1,1,,,,\n"
            "box,8,2,0,3,1.4142135623730951,0.5,\n");
}

TEST_F(TablesTest, TimingIsApartBecauseItIsNotTheSameTwice) {
  add_run(0, R"({"mean_error_mm": 2})");
  add_failure(1, "broken");
  write_tables();
  EXPECT_EQ(
      table("timing.csv"),
      "scene,optimizer.particles,seed,fps,search_fps,evaluations_per_second,seconds,threads,gpu"
      "\n"
      "box,16,1,20.5,8.5,1000,1.5,2,1\n");
}

TEST_F(TablesTest, ADamagedFileIsNamedWithTheFolderToRemove) {
  add_run(0, "{\"mean_error_mm\": ");
  const std::string folder = run_folder(0).string();
  EXPECT_THAT(
      [&] { write_tables(); },
      testing::ThrowsMessage<DataError>(testing::AllOf(
          testing::StartsWith(folder + "/metrics.json: is no JSON"),
          testing::EndsWith("remove the folder " + folder + " and the run will be made again"))));
}

TEST_F(TablesTest, ARunThatKnewTheTruthNeedsItsMetrics) {
  add_run(0, "{}");
  std::filesystem::remove(run_folder(0) / "metrics.json");
  std::ofstream(run_folder(0) / "errors.csv") << "frame,time,status,mean_joint_error_mm,box\n";
  const std::string folder = run_folder(0).string();
  EXPECT_THAT(
      [&] { write_tables(); },
      testing::ThrowsMessage<DataError>(testing::AllOf(
          testing::StartsWith(folder + "/metrics.json: no such file"),
          testing::EndsWith("remove the folder " + folder + " and the run will be made again"))));
}

TEST_F(TablesTest, ANumberThatNoRunCanHaveIsNamedWithTheFolderToRemove) {
  const std::string folder = run_folder(0).string();
  for (const auto& [number, found] :
       {std::pair{R"("mean_error_mm": "x")", "'mean_error_mm' is a text"},
        std::pair{R"("mean_error_mm": [1])", "'mean_error_mm' is a list"},
        std::pair{R"("mean_error_mm": {})", "'mean_error_mm' is a map"},
        std::pair{R"("mean_error_mm": true)", "'mean_error_mm' is true"},
        std::pair{R"("mean_error_mm": null)", "'mean_error_mm' is null"},
        std::pair{R"("jitter_mm": -5)", "'jitter_mm' is -5"},
        std::pair{R"("frames": null)", "'frames' is null"}}) {
    add_run(0, std::string(R"({"evaluated_frames": 2, )") + number + "}");
    EXPECT_THAT([&] { write_tables(); },
                testing::ThrowsMessage<DataError>(
                    testing::StrEq(folder + "/metrics.json: " + found +
                                   ", expected a number of at least 0; remove the folder " +
                                   folder + " and the run will be made again")));
  }
}

TEST_F(TablesTest, NumbersThatARunMayLackAreEmpty) {
  add_run(0, R"({"evaluated_frames": 0, "mean_error_mm": null, "time_to_loss_s": -0.5})");
  add_run(1, R"({"evaluated_frames": 2, "mean_error_mm": 3, "jitter_mm": null})");
  write_tables();
  EXPECT_EQ(table("results.csv"),
            "scene,optimizer.particles,seed,status,message,evaluated_frames,mean_error_mm,"
            "time_to_loss_s,jitter_mm\n"
            "box,16,1,ok,,0,,-0.5,\n"
            "box,8,1,ok,,2,3,,\n");
}

TEST_F(TablesTest, ADamagedNumberOfTheSummaryIsNamed) {
  add_run(0, "{}");
  std::ofstream(run_folder(0) / "summary.json") << R"({"complete": true, "fps": "fast"})";
  EXPECT_THAT([&] { write_tables(); },
              testing::ThrowsMessage<DataError>(testing::StartsWith(
                  run_folder(0).string() + "/summary.json: 'fps' is a text, expected a number")));
}

TEST_F(TablesTest, WithoutGroundTruthTheSummaryIsCompared) {
  add_run(0, "{}");
  const std::filesystem::directory_iterator only(path("out/runs"));
  std::filesystem::remove(only->path() / "metrics.json");
  write_tables();
  EXPECT_EQ(table("results.csv"),
            "scene,optimizer.particles,seed,status,message,frames,lost_frames\n"
            "box,16,1,ok,,5,1\n");
}

}  // namespace
}  // namespace hypotrack::test
