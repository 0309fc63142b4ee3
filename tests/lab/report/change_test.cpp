#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "lab/report/change_data.hpp"
#include "lab/report/report.hpp"
#include "study_fixture.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Eight seeds of two settings in two scenes.
test::StudyFixture fixture_of(double error_mm) {
  test::StudyFixture fixture{.seeds = 8, .particles = {16, 256}, .generations = {16}};
  fixture.run.error_mm = error_mm;
  return fixture;
}

class ChangeTest : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  Json change(const test::StudyFixture& before, const test::StudyFixture& after) const {
    test::write_study(path("before"), before);
    test::write_study(path("after"), after);
    return change_data(read_study(path("before")), read_study(path("after")));
  }
  static std::string fact(const Json& page, const std::string& name) {
    for (const Json& fact : page["facts"])
      if (fact[0] == name) return fact[1];
    return "";
  }

 private:
  test::TemporaryDirectory folder_;
};

TEST_F(ChangeTest, PutsTheSameCellsSideBySideAndTestsTheDifference) {
  const Json page = change(fixture_of(5), fixture_of(4));
  ASSERT_THAT(page["tables"], SizeIs(2));
  const Json& table = page["tables"][0];
  EXPECT_EQ(table["title"], "SH, stereo");
  EXPECT_EQ(table["columns"][0]["key"], "mean_error_mm");
  ASSERT_THAT(table["rows"], SizeIs(2));
  const Json& cell = table["rows"][1]["cells"][0];
  EXPECT_EQ(table["rows"][1]["keys"], (Json{"256", "16"}));
  EXPECT_NEAR(cell["after"].get<double>() / cell["before"].get<double>(), 0.8, 1e-3);
  EXPECT_DOUBLE_EQ(cell["difference"], cell["after"].get<double>() - cell["before"].get<double>());
  EXPECT_DOUBLE_EQ(cell["p"], 2 * 2 / 256.0);  // eight pairs, all in one direction; two cells
  EXPECT_EQ(cell["verdict"], "better");
  EXPECT_EQ(fact(page, "cells compared"), "4");
  EXPECT_EQ(fact(page, "error better"), "4");
  EXPECT_EQ(fact(change(fixture_of(4), fixture_of(5)), "error worse"), "4");
}

TEST_F(ChangeTest, TooFewSeedsLeaveTheDifferenceOpenAndSayHowManyItTakes) {
  test::StudyFixture before = fixture_of(5), after = fixture_of(4);
  before.seeds = after.seeds = 3;
  const Json page = change(before, after);
  const Json& cell = page["tables"][0]["rows"][0]["cells"][0];
  EXPECT_EQ(cell["verdict"], "open");
  EXPECT_GE(cell["seeds_needed"], 7);  // 2 / 2^7 < 0.05 / 2
}

TEST_F(ChangeTest, EqualResultsAreTheSame) {
  const Json page = change(fixture_of(5), fixture_of(5));
  EXPECT_EQ(page["tables"][0]["rows"][0]["cells"][0]["verdict"], "same");
  EXPECT_EQ(fact(page, "error the same"), "4");
}

TEST_F(ChangeTest, CellsOfOneStudyOnlyAreLeftOutAndCounted) {
  test::StudyFixture after = fixture_of(5);
  after.particles = {16, 64, 128};
  const Json page = change(fixture_of(5), after);
  EXPECT_THAT(page["tables"][0]["rows"], SizeIs(1));
  EXPECT_EQ(page["left_out"], "6 cells of one study only are left out.");
}

TEST_F(ChangeTest, RefusesWhatHasNothingInCommon) {
  test::StudyFixture after = fixture_of(5);
  after.particles = {8};
  EXPECT_THAT(message_of<DataError>([&] { change(fixture_of(5), after); }),
              HasSubstr("have no cell in common"));
  test::write_run(path("run"), {});
  EXPECT_THAT(message_of<DataError>(
                  [&] { change_data(read_study(path("before")), read_study(path("run"))); }),
              HasSubstr("run: is a run; expected the folders of a study before and after"));
}

TEST_F(ChangeTest, IsOnePageWithTablesInTheFolderOfTheStudyAfter) {
  test::write_study(path("before"), fixture_of(5));
  test::write_study(path("after"), fixture_of(4));
  PluginLoader plugins;
  const ReportSummary summary =
      write_report({.directory = path("before"), .after = path("after"), .out = {}}, plugins);
  EXPECT_EQ(summary.page, path("after/changes.html"));
  EXPECT_EQ(summary.runs, 64U);
  std::ifstream in(path("after/changes/tables/change-1.csv"));
  std::string header;
  std::getline(in, header);
  EXPECT_THAT(header, testing::StartsWith("particles,generations,samples_before,samples_after,"
                                          "mean_error_mm_before,mean_error_mm_after,"));
}

}  // namespace
}  // namespace hypotrack
