#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// Plugins that use what a run offers them besides frames and hypotheses.
class PluginContextTest : public AppTest {
 protected:
  static std::string with_term(const std::string& parameters = "") {
    return replaced(box_scene(), "{type: stereo_color}",
                    "[{type: telling" + parameters + "}, {type: stereo_color}]");
  }
  Outcome run_with_plugins(const std::string& text, std::vector<std::string> more = {}) const {
    more.insert(more.end(),
                {"--plugin-path", (build_dir() / "tests/plugin_fixtures/app").string()});
    return run(text, more);
  }
  nlohmann::json summary() const {
    return nlohmann::json::parse(read_text(path("out/summary.json")));
  }
  std::vector<std::string> column(const std::string& name) const {
    std::vector<std::string> cells;
    std::ptrdiff_t place = -1;
    for (const std::string& line : lines_of(read_text(path("out/track.csv")))) {
      std::vector<std::string> row;
      std::istringstream text(line);
      for (std::string cell; std::getline(text, cell, ',');) row.push_back(cell);
      if (place < 0) {
        place = std::ranges::find(row, name) - row.begin();
        EXPECT_LT(place, std::ssize(row)) << name;
      } else {
        cells.push_back(row.at(static_cast<std::size_t>(place)));
      }
    }
    return cells;
  }
  static std::ptrdiff_t count(const std::string& text, const std::string& piece) {
    std::ptrdiff_t n = 0;
    for (auto at = text.find(piece); at != std::string::npos; at = text.find(piece, at + 1)) ++n;
    return n;
  }
};

TEST_F(PluginContextTest, NotesNameThePluginAndTheFrameAndAreSaidOnce) {
  const Outcome outcome = run_with_plugins(with_term());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("note: objective.0 (telling): was made\n"),
                    HasSubstr("note: objective.0 (telling), frame 0: prepares frames\n"),
                    HasSubstr("warning: objective.0 (telling), frame 0: a cost of "
                              "several threads\n")));
  EXPECT_EQ(count(outcome.err, "prepares frames"), 2) << "once, and at the end how often";
  EXPECT_THAT(outcome.err, testing::ContainsRegex("prepares frames \\([0-9]+ times\\)"));
  std::int64_t costs = 0;
  const auto told = summary();
  for (const auto& note : told.at("notes")) {
    EXPECT_EQ(note.at("plugin"), "objective.0 (telling)");
    if (note.at("level") != "warning") continue;
    EXPECT_EQ(note.at("text"), "a cost of several threads");
    EXPECT_EQ(note.at("first_frame"), 0);
    costs += note.at("count").get<std::int64_t>();
  }
  EXPECT_GE(costs, 5 * 32) << "every cost of five frames";
}

TEST_F(PluginContextTest, APluginWithManyTextsIsCutOff) {
  const Outcome outcome = run_with_plugins(with_term(", different: 1000"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              HasSubstr("has told 20 different things; further ones are only counted"));
  EXPECT_LT(lines_of(outcome.err).size(), 100U);
  EXPECT_EQ(summary().at("notes").size(), 21U);
}

TEST_F(PluginContextTest, ARunWithoutNotesSaysNothingOfThem) {
  const Outcome outcome = run(box_scene());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_FALSE(summary().contains("notes"));
}

TEST_F(PluginContextTest, ATermKnowsThePreviousAnswer) {
  const Outcome outcome = run_with_plugins(with_term());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("frame 0: no earlier frame"),
                                 HasSubstr("frame 1: after frame 0, 0.033 s, tiles 0\n"),
                                 HasSubstr("frame 4: after frame 3, 0.033 s, tiles 0\n"),
                                 Not(HasSubstr("a time of none")), Not(HasSubstr("wrong"))));
}

TEST_F(PluginContextTest, ATermThatAsksForThemKnowsThePreviousTiles) {
  const Outcome outcome = run_with_plugins(with_term(", tiles: true"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("frame 1: after frame 0, 0.033 s, tiles 2\n"),
                                 HasSubstr("frame 4: after frame 3, 0.033 s, tiles 2\n"),
                                 Not(HasSubstr("not as promised"))));
}

TEST_F(PluginContextTest, FixedLagSmoothingGivesNoPreviousAnswer) {
  const Outcome outcome = run_with_plugins(
      with_term(", tiles: true"),
      {"--set", "smoothing.fixed_lag.enabled=true", "--set", "budget.evaluations=256"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("no motion is assumed"),
                                 HasSubstr("frame 1: after frame 0, 0.033 s, tiles 2\n"),
                                 Not(HasSubstr("some motion is assumed"))));
}

TEST_F(PluginContextTest, AnOptimizerKnowsThePreviousAnswer) {
  const Outcome outcome = run_with_plugins(
      replaced(box_scene(), "{type: pso, particles: 8, generations: 4}", "{type: telling}"),
      {"--set", "recovery.enabled=false"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("note: optimizer (telling), frame 1: starts at the previous answer"),
                    Not(HasSubstr("starts elsewhere")), Not(HasSubstr("no time has passed"))));
}

TEST_F(PluginContextTest, TheSummaryHasTheTimeOfEveryTerm) {
  const Outcome outcome = run_with_plugins(with_term());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto terms = summary().at("terms");
  ASSERT_EQ(terms.size(), 2U);
  EXPECT_EQ(terms[0].at("term"), "objective.0 (telling)");
  EXPECT_EQ(terms[1].at("term"), "objective.1 (stereo_color)");
  for (const auto& term : terms) {
    EXPECT_GT(term.at("prepare_s"), 0);
    EXPECT_GT(term.at("cost_s"), 0);
  }
}

TEST_F(PluginContextTest, AnOutputAddsColumnsToTheTable) {
  const std::string text =
      replaced(box_scene(), "{overlay: false}", "{overlay: false, also: {type: telling}}");
  const Outcome outcome = run_with_plugins(text);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(lines_of(read_text(path("out/track.csv")))[0],
              testing::EndsWith(",fault,depth_m,odd"));
  EXPECT_EQ(column("depth_m"), column("box.position_z"));
  EXPECT_THAT(column("odd"), testing::ElementsAre("nan", "1", "nan", "3", "nan"));
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("note: output.also (telling), frame 3: sees a frame"),
                                 HasSubstr("note: output.also (telling): ends")));
  EXPECT_EQ(summary().at("notes").size(), 2U) << "also what is said at the end";
  EXPECT_EQ(run_program({"evaluate", path("out").string()}).exit_code, 0);
  const std::string again = replaced(box_scene(), "{from: truth}",
                                     "{from: file, file: " + path("out/track.csv").string() + "}");
  EXPECT_EQ(run_program({"validate", scene(again, "again.yaml")}).exit_code, 0);
}

TEST_F(PluginContextTest, ColumnsOfOneNameAreRefused) {
  const auto with = [](const std::string& also) {
    return replaced(box_scene(), "{overlay: false}", "{overlay: false, also: " + also + "}");
  };
  const std::string here = (build_dir() / "tests/plugin_fixtures/app").string();
  expect_refused(with("[{type: telling}, {type: telling}]"),
                 {"telling and telling both add the column 'depth_m'", "leave one of them out"},
                 {"--plugin-path", here});
  expect_refused(with("{type: telling, column: cost}"),
                 {"the column 'cost'", "which the table has already"}, {"--plugin-path", here});
  expect_refused(with("{type: telling, column: 'a,b'}"),
                 {"the column 'a,b'", "expected letters, digits and _"}, {"--plugin-path", here});
}

}  // namespace
}  // namespace hypotrack::test
