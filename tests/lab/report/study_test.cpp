#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "lab/report/plots/plot_data.hpp"
#include "lab/report/report_data.hpp"
#include "lab/report/statistics/comparison.hpp"
#include "lab/report/study_data.hpp"
#include "lab/report/tables/table_data.hpp"
#include "study_fixture.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using test::write_study;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

namespace fs = std::filesystem;

class StudyTest : public testing::Test {
 protected:
  StudyData study(const test::StudyFixture& fixture = {}) const {
    write_study(folder(), fixture);
    return read_study(folder());
  }
  fs::path folder() const { return folder_.path() / "study"; }
  void overwrite(const fs::path& file, const std::string& text) const {
    std::ofstream(folder() / file, std::ios::binary) << text;
  }
  /// Writes a plan of the runs that are there.
  void write_plan() const {
    std::string names;
    for (const auto& entry : fs::directory_iterator(folder() / "runs"))
      names += entry.path().filename().string() + "\n";
    overwrite("plan.txt", names);
  }
  std::string refusal() const {
    return message_of<Error>([&] { read_study(folder()); });
  }

 private:
  test::TemporaryDirectory folder_;
};

TEST_F(StudyTest, ReadsRunsInTheOrderOfTheGrid) {
  const StudyData data = study({.particles = {64, 16}});
  EXPECT_EQ(data.title, "Error over the budget");
  ASSERT_THAT(data.axes, SizeIs(2));
  EXPECT_EQ(data.axes[0].label, "particles");
  EXPECT_TRUE(data.axes[0].numeric);
  EXPECT_THAT(data.axes[0].values, ElementsAre("64", "16"));
  EXPECT_EQ(data.value_label("scene", "rgbd"), "SH, RGBD");
  ASSERT_THAT(data.runs, SizeIs(24));
  EXPECT_EQ(data.planned, 24U);
  EXPECT_EQ(data.runs[0].id, "stereo_p64_g16_s1");
  EXPECT_EQ(data.runs[1].id, "stereo_p64_g16_s2");
  EXPECT_EQ(data.runs[6].id, "stereo_p16_g16_s1");
  EXPECT_GT(data.runs[0].number("mean_error_mm"), 0);
  EXPECT_TRUE(std::isnan(data.runs[0].number("time_to_loss_s")));
  EXPECT_EQ(data.runs[0].number("evaluations_per_second"), 20480);
}

TEST_F(StudyTest, KeepsFailuresAsRuns) {
  const StudyData data = study({.failure_message = "no such camera"});
  EXPECT_TRUE(data.runs.back().failed);
  EXPECT_EQ(data.runs.back().message, "no such camera");
  EXPECT_EQ(table_data(data).back()["rows"].back()["failed"], 1);
}

TEST_F(StudyTest, CountsWhatAnUnfinishedStudyLacks) {
  study();
  fs::remove_all(folder() / "runs" / "stereo_p16_g16_s2");
  fs::create_directories(folder() / "runs" / ".part.stereo_p16_g16_s2");
  const StudyData data = read_study(folder());
  EXPECT_THAT(data.runs, SizeIs(23));
  EXPECT_EQ(data.planned, 24U);
}

TEST_F(StudyTest, CountsTheRunsOfItsPlanOnly) {
  study();
  write_plan();
  const fs::path run = folder() / "runs" / "stereo_p16_g16_s1";
  fs::copy(run, run.string() + ".bak");
  fs::create_directory(folder() / "runs" / "notes");
  EXPECT_THAT(read_study(folder()).runs, SizeIs(24));
  fs::remove_all(run);
  EXPECT_THAT(read_study(folder()).runs, SizeIs(23));
}

TEST_F(StudyTest, NamesARunOfItsPlanThatLostItsCell) {
  study();
  write_plan();
  const fs::path run = folder() / "runs" / "stereo_p16_g16_s1";
  fs::remove(run / "cell.json");
  EXPECT_EQ(refusal(), (run / "cell.json").string() +
                           ": no such file; expected a JSON object; remove the folder " +
                           run.string() + " and the run will be made again");
}

TEST_F(StudyTest, NamesATrackWithFewerRowsThanTheRunHadFrames) {
  study();
  const fs::path run = fs::path("runs") / "stereo_p16_g16_s1";
  overwrite(run / "track.csv",
            "frame,time,status,cost,evaluations,milliseconds\n0,0,lost,1,8,20\n");
  EXPECT_THAT(refusal(), HasSubstr("s1/track.csv: has 1 rows, expected "));
}

TEST_F(StudyTest, RefusesWhatIsNoStudy) {
  EXPECT_THAT(refusal(), HasSubstr("no such folder; expected a study folder"));
  fs::create_directories(folder());
  EXPECT_THAT(refusal(), HasSubstr("is neither a study folder (it has no study.yaml) nor a run"));
  overwrite("study.yaml", "title: Empty\n");
  EXPECT_THAT(refusal(), HasSubstr("has no finished run in "));
}

TEST_F(StudyTest, NamesTheDamagedFile) {
  study();
  const fs::path run = fs::path("runs") / "stereo_p16_g16_s1";
  overwrite(run / "metrics.json", "{\"mean_error_mm\": ");
  EXPECT_THAT(refusal(), testing::AllOf(HasSubstr("s1/metrics.json: is no JSON"),
                                        HasSubstr("repeat the run that wrote it")));
  overwrite(run / "metrics.json", "[1]");
  EXPECT_THAT(refusal(), HasSubstr("holds a JSON array, expected an object"));
  overwrite(run / "metrics.json", "{\"success_curve\": {\"threshold_mm\": [1], \"share\": []}}");
  EXPECT_THAT(refusal(), HasSubstr("has 1 thresholds and 0 shares"));
  overwrite(run / "metrics.json", "{\"mean_error_mm\": \"x\"}");
  EXPECT_THAT(refusal(), HasSubstr("'mean_error_mm' is a text, expected a number of at least 0"));
  fs::remove(folder() / run / "metrics.json");  // but not errors.csv
  EXPECT_THAT(refusal(), HasSubstr("s1/metrics.json: no such file"));
  overwrite(run / "metrics.json", "{}");
  overwrite(run / "cell.json", "{\"scene\": 3}");
  EXPECT_THAT(refusal(), HasSubstr("cell.json: 'scene' is number, expected a text"));
  for (const char* seed : {"1e+300", "1.5", "18446744073709551615"}) {
    overwrite(run / "cell.json", fmt::format("{{\"scene\": \"a\", \"seed\": {}}}", seed));
    EXPECT_THAT(refusal(),
                HasSubstr("cell.json: 'seed' is " + std::string(seed) + ", expected a whole"));
  }
  overwrite(run / "cell.json", R"({"scene": "a"})");
  EXPECT_THAT(refusal(), HasSubstr("cell.json: 'seed' is missing, expected a whole number"));
  overwrite("study.yaml", "title: [");
  EXPECT_THAT(refusal(), HasSubstr("study.yaml:"));
}

TEST_F(StudyTest, RefusesFilesOfDeepNesting) {
  study();
  const std::string deep(1'000'000, '[');
  overwrite("runs/stereo_p16_g16_s1/metrics.json",
            "{\"models\": " + deep + std::string(deep.size(), ']') + "}");
  EXPECT_THAT(refusal(), HasSubstr("s1/metrics.json: is nested more than 64 levels deep; repeat"));
}

TEST_F(StudyTest, PlansNoMoreSeedsThanAStudyMayHave) {
  study();
  overwrite("study.yaml", "title: a\nseeds: 1e300\nscenes: {stereo: {}}\n");
  EXPECT_EQ(read_study(folder()).planned, 1U);
}

TEST_F(StudyTest, TablesMarkTheBestAndWhatSeedsDoNotSeparateFromIt) {
  const StudyData data = study({.seeds = 8, .particles = {16, 256}, .generations = {16}});
  const auto tables = table_data(data);
  ASSERT_THAT(tables, SizeIs(3));
  EXPECT_EQ(tables[0]["id"], "table-scenes");
  const auto& rows = tables[1]["rows"];
  EXPECT_EQ(tables[1]["identical"], "");
  EXPECT_EQ(tables[1]["columns"][0]["label"], "mean error (mm)");
  EXPECT_EQ(rows[1]["keys"][0], "256");
  EXPECT_TRUE(rows[1]["cells"][0]["best"]);
  EXPECT_FALSE(rows[0]["cells"][0]["same"]);
  EXPECT_DOUBLE_EQ(rows[0]["cells"][0]["p"], 2 / 256.0);  // eight pairs, all in one direction
  EXPECT_THAT(tables[1]["note"].get<std::string>(), HasSubstr("not separated from the best by 8"));
}

TEST_F(StudyTest, ATablePerValueOfAnAxisComparesRowsWithinIt) {
  study({.seeds = 8, .particles = {16, 256}, .generations = {16, 64}});
  std::ofstream(folder() / "study.yaml", std::ios::app) << "\ntable_per: optimizer.generations\n";
  const auto tables = table_data(read_study(folder()));
  ASSERT_THAT(tables, SizeIs(6));  // two with the scenes side by side, then two of each scene
  EXPECT_EQ(tables[1]["id"], "table-scenes-64");
  EXPECT_EQ(tables[2]["id"], "table-1-stereo-16");
  EXPECT_EQ(tables[3]["id"], "table-1-stereo-64");
  EXPECT_THAT(tables[3]["title"].get<std::string>(), HasSubstr("generations 64"));
  for (const int table : {2, 3}) {
    const auto& rows = tables[table]["rows"];
    ASSERT_THAT(rows, SizeIs(2));
    EXPECT_EQ(rows[0]["keys"][1], table == 2 ? "16" : "64");
    EXPECT_TRUE(rows[1]["cells"][0]["best"]);
    EXPECT_DOUBLE_EQ(rows[0]["cells"][0]["p"], 2 / 256.0);  // one comparison
  }
}

TEST_F(StudyTest, TablesSayWhenThereAreTooFewSeedsForAnyTest) {
  const auto tables = table_data(study({.seeds = 3, .particles = {16, 256}, .generations = {16}}));
  EXPECT_TRUE(tables[1]["rows"][0]["cells"][0]["same"]);
  EXPECT_THAT(tables[1]["note"].get<std::string>(),
              HasSubstr("even the clearest difference would have p = 0.25; at least 6 seeds are "
                        "needed"));
  EXPECT_GE(tables[1]["rows"][0]["cells"][0]["seeds_needed"], 6);
}

TEST_F(StudyTest, TheTableOfScenesMarksTheBestSettingOfEachScene) {
  const auto tables = table_data(study({.seeds = 8, .particles = {16, 256}, .generations = {16}}));
  const auto& rows = tables[0]["rows"];
  ASSERT_EQ(tables[0]["columns"].size(), 2U);
  for (const int scene : {0, 1}) {
    EXPECT_FALSE(rows[0]["cells"][scene]["best"]);
    EXPECT_TRUE(rows[1]["cells"][scene]["best"]);
    EXPECT_EQ(rows[1]["cells"][scene]["mean"],
              tables[static_cast<std::size_t>(1 + scene)]["rows"][1]["cells"][0]["mean"]);
  }
  EXPECT_EQ(rows[0]["runs"], 16);
  EXPECT_THAT(rows[1]["cells"][0]["detail"].get<std::string>(),
              testing::MatchesRegex("1024 evaluations · [0-9.]+ fps · [0-9.]+ % lost"));
}

TEST_F(StudyTest, TablesShowTheCostBesideTheError) {
  std::vector<std::string> keys;
  const auto tables = table_data(study());
  for (const auto& column : tables[1]["columns"]) keys.push_back(column["key"]);
  keys.resize(4);
  EXPECT_THAT(keys, ElementsAre("mean_error_mm", "lost_share", "evaluations_per_frame", "fps"));
}

TEST_F(StudyTest, RunsThatAreTheSameBitByBitAreOneSample) {
  const StudyData data =
      study({.seeds = 8, .particles = {16, 256}, .generations = {16}, .same = true});
  const auto table = table_data(data)[1];
  const auto& row = table["rows"][0];
  EXPECT_EQ(row["runs"], 8);
  EXPECT_EQ(row["samples"], 1);
  EXPECT_EQ(row["cells"][0]["n"], 1);
  EXPECT_TRUE(row["cells"][0]["sd"].is_null());
  EXPECT_EQ(row["cells"][0]["p"], 1);  // of 8 pairs it would be 0.008
  EXPECT_TRUE(row["cells"][0]["same"]);
  EXPECT_THAT(table["identical"].get<std::string>(),
              testing::AllOf(HasSubstr("count as one sample"),
                             HasSubstr("16, 16: 8 runs, 1 sample; 256, 16: 8 runs, 1 sample")));
}

TEST_F(StudyTest, TimesDoNotMakeResultsDifferent) {
  study({.seeds = 2, .same = true});
  const fs::path file = fs::path("runs") / "stereo_p16_g16_s2" / "track.csv";
  std::ifstream in(folder() / file);
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const auto samples = [&] { return table_data(read_study(folder()))[1]["rows"][0]["samples"]; };
  text.replace(text.find(",1024,") + 6, 1, "7");  // milliseconds
  overwrite(file, text);
  EXPECT_EQ(samples(), 1);
  text.replace(text.find(",1024,"), 6, ",1023,");
  overwrite(file, text);
  EXPECT_EQ(samples(), 2);
}

TEST(ComparisonTest, PairsEqualSeedsAndRanksOthers) {
  const Sample a{{1, 2, 3, 4, 5, 6}, {1, 2, 3, 4, 5, 6}};
  const Sample paired{{1, 2, 3, 4, 5, 6}, {1.1, 2.1, 3.1, 4.1, 5.1, 6.1}};
  Sample other = paired;
  other.seeds = {7, 8, 9, 10, 11, 12};
  EXPECT_DOUBLE_EQ(test_difference(a, paired), 2 / 64.0);
  EXPECT_GT(test_difference(a, other), 0.5);
}

TEST(ComparisonTest, ChoosesNoBestWhereNeitherEndIsBetterOrNothingCompares) {
  const std::vector<Sample> two{{{1}, {3}}, {{1}, {4}}};
  EXPECT_TRUE(compare_samples(two, MetricInfo::Better::lower)[0].best);
  EXPECT_TRUE(compare_samples(two, MetricInfo::Better::higher)[1].best);
  for (const Comparison& c : compare_samples(two, MetricInfo::Better::neither))
    EXPECT_FALSE(c.best || c.p);
  const auto alone = compare_samples({{{1}, {3}}, {}}, MetricInfo::Better::lower);
  EXPECT_FALSE(alone[0].best);
  EXPECT_TRUE(std::isnan(alone[1].mean));
}

TEST_F(StudyTest, PlotsAreMeansOverTheSeedsOfAPlace) {
  const StudyData data = study(
      {.plots = "  - {kind: curve, x: optimizer.particles, y: mean_error_mm, color: "
                "optimizer.generations, facet: scene, title: Budget}\n"
                "  - {kind: success, color: optimizer.particles}\n"
                "  - {kind: heatmap, x: optimizer.particles, y: optimizer.generations, value: "
                "lost_share}\n"});
  const auto plots = plot_data(data);
  ASSERT_THAT(plots, SizeIs(3));
  EXPECT_EQ(plots[0]["title"], "Budget");
  ASSERT_THAT(plots[0]["facets"], SizeIs(2));
  EXPECT_EQ(plots[0]["facets"][1]["label"], "SH, RGBD");
  const auto& row = plots[0]["facets"][0]["rows"][0];
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += data.runs[static_cast<std::size_t>(i)].number("mean_error_mm");
  EXPECT_DOUBLE_EQ(row["mean"], sum / 3);
  EXPECT_EQ(row["n"], 3);
  EXPECT_EQ(row["x"], 16);
  EXPECT_EQ(row["color"], 16);
  EXPECT_EQ(plots[0]["note"], "");
  EXPECT_EQ(plots[1]["facets"][0]["rows"].size(), 2U * 51);
  EXPECT_EQ(plots[1]["note"], "Averaged over scene, generations as well as seeds.");
  EXPECT_EQ(plots[2]["value"]["label"], "frames lost (%)");
}

TEST_F(StudyTest, PlotsOfWhatIsNotThereAreRefused) {
  const auto refused = [&](const std::string& plot) {
    return message_of<DataError>([&] { plot_data(study({.plots = "  - " + plot + "\n"})); });
  };
  EXPECT_THAT(refused("{kind: pie}"), HasSubstr("'pie' is no kind of plot; expected curve"));
  EXPECT_THAT(
      refused("{kind: curve, x: optimizer.swarm, y: mean_error_mm}"),
      HasSubstr("'optimizer.swarm', which the study does not vary; expected one of: scene, seed, "
                "optimizer.particles, optimizer.generations"));
  EXPECT_THAT(refused("{kind: curve, x: scene, y: error}"),
              HasSubstr("'error', which no run has in its metrics.json"));
}

TEST_F(StudyTest, SeedsCanBeAnAxis) {
  const StudyData data = study({.plots = "  - {kind: curve, x: seed, y: mean_error_mm, color: "
                                         "optimizer.particles, facet: scene}\n"});
  const auto plot = plot_data(data)[0];
  EXPECT_EQ(plot["x"]["values"], (nlohmann::ordered_json{1, 2, 3}));
  EXPECT_EQ(plot["note"], "Averaged over generations.");
}

TEST_F(StudyTest, PlotsOfErrorsAreEmptyWhereNoTruthIsKnown) {
  test::StudyFixture fixture;
  fixture.run.truth_states = fixture.run.truth_landmarks = false;
  const StudyData data = study(fixture);
  EXPECT_EQ(data.runs[0].number("frames"), 12);
  for (const auto& plot : plot_data(data))
    for (const auto& facet : plot["facets"]) EXPECT_THAT(facet["rows"], IsEmpty());
  EXPECT_EQ(table_data(data)[0]["columns"][0]["key"], "evaluations_per_frame");
}

TEST_F(StudyTest, RunsHaveTheTimeOfAFrameToo) {
  const StudyRun run = study().runs[0];
  EXPECT_DOUBLE_EQ(run.number("frame_seconds"), 1 / run.number("fps"));
}

TEST_F(StudyTest, AStudyWithoutPlotsGetsSomeThatFitItsAxes) {
  std::vector<std::string> kinds;
  for (const PlotRequest& plot : default_plots(study())) kinds.push_back(plot.kind);
  EXPECT_THAT(kinds, ElementsAre("curve", "heatmap", "success"));
  EXPECT_THAT(plot_data(study()), SizeIs(3));
}

TEST_F(StudyTest, ReplaysGoToMedianRunsFromWorstToBest) {
  const StudyData data = study({.particles = {16, 64, 256}, .generations = {16}});
  const auto chosen = runs_to_replay(data, 2);
  ASSERT_THAT(chosen, SizeIs(2));
  EXPECT_THAT(data.runs[chosen[0]].id, HasSubstr("stereo_p16"));  // the largest error
  EXPECT_THAT(data.runs[chosen[1]].id, HasSubstr("rgbd_p256"));   // the smallest
  EXPECT_THAT(runs_to_replay(data, 100), SizeIs(6));              // one of each cell
  EXPECT_THAT(runs_to_replay(data, 0), IsEmpty());
}

}  // namespace
}  // namespace hypotrack
