#include "lab/report/report.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "lab/report/packed.hpp"
#include "lab/report/page.hpp"
#include "lab/report/replay.hpp"
#include "lab/report/report_data.hpp"
#include "study_fixture.hpp"
#include "test_models.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using test::write_run;
using test::write_study;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Pair;
using testing::SizeIs;

namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Of a page, which is too long for the message of a matcher.
bool holds(const std::string& page, std::string_view text) {
  return page.find(text) != std::string::npos;
}

class ReportTest : public testing::Test {
 protected:
  fs::path run() const { return folder_.path() / "run"; }
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  ReportSummary report(ReportOptions options) {
    options.plot_files = PlotFiles::none;
    return write_report(options, plugins_);
  }
  std::string refusal(const ReportOptions& options) {
    return message_of<Error>([&] { report(options); });
  }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      names.push_back(entry.path().filename().string());
    return names;
  }
  PluginLoader plugins_;

 private:
  test::TemporaryDirectory folder_;
};

TEST_F(ReportTest, OfAStudyIsOneFileWithTablesBesideIt) {
  write_study(path("study"), {});
  const ReportSummary summary = report({.directory = path("study"), .out = {}});
  EXPECT_EQ(summary.runs, 24U);
  EXPECT_EQ(summary.replays, 8U);  // as many as there are cells
  const std::string page = read_text(path("study") / "report.html");
  EXPECT_EQ(page.size(), summary.bytes);
  for (const char* outside : {"src=\"http", "href=\"http", "@import", "url(http", "{{title"})
    EXPECT_FALSE(holds(page, outside)) << outside;
  EXPECT_TRUE(holds(page, "cuda (NVIDIA H200, GPU 1)"));
  const std::string table = read_text(path("study") / "report/tables/table-1-stereo.csv");
  EXPECT_THAT(table,
              testing::StartsWith("particles,generations,runs,samples,failed,mean_error_mm_mean,"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 5);
  for (const char* timed : {"fps", "frame_seconds"})
    EXPECT_THAT(table, Not(HasSubstr(timed)));  // the same study gives the same tables
  const std::string runs = read_text(path("study") / "report/tables/runs.csv");
  EXPECT_EQ(std::count(runs.begin(), runs.end(), '\n'), 25);
}

TEST_F(ReportTest, SameStudySamePage) {
  write_study(path("study"), {.seeds = 1});
  report({.directory = path("study"), .out = path("a.html")});
  report({.directory = path("study"), .out = path("b.html")});
  EXPECT_TRUE(read_text(path("a.html")) == read_text(path("b.html")));
}

TEST_F(ReportTest, TextsOfOthersCannotEndTheScript) {
  write_study(path("study"),
              {.seeds = 1,
               .title = "</title></script><script>alert(1)</script>",
               .failure_message = "</script><img src=x onerror=alert(1)>, \"quoted\""});
  report({.directory = path("study"), .out = {}});
  const std::string page = read_text(path("study") / "report.html");
  EXPECT_FALSE(holds(page, "<script>alert(1)"));
  EXPECT_FALSE(holds(page, "<img src=x"));
  EXPECT_TRUE(holds(page, "&lt;script&gt;alert(1)"));
  EXPECT_THAT(read_text(path("study") / "report/tables/runs.csv"),
              HasSubstr("\"</script><img src=x onerror=alert(1)>, \"\"quoted\"\"\""));
}

TEST(PageTest, ScriptDataAndHtmlAreEscaped) {
  EXPECT_EQ(escape_html("<a href=\"x\">'&'</a>"),
            "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;&lt;/a&gt;");
  EXPECT_EQ(script_json({{"a", "</script><!--"}}), R"({"a":"\u003c/script>\u003c!--"})");
  EXPECT_EQ(script_json({{"a", "\xff"}}), "{\"a\":\"\xEF\xBF\xBD\"}");
}

TEST_F(ReportTest, LeavesAnEarlierReportWhereItFails) {
  write_run(run(), {});
  report({.directory = run(), .out = path("r.html")});
  const std::string before = read_text(path("r.html"));
  std::string track = "frame,time\n";
  for (int frame = 0; frame < test::RunFixture().frames; ++frame)
    track += std::to_string(frame) + ",zero\n";
  std::ofstream(run() / "track.csv") << track;
  EXPECT_THAT(refusal({.directory = run(), .out = path("r.html")}),
              HasSubstr("track.csv: has no column 'status'"));
  EXPECT_TRUE(read_text(path("r.html")) == before);
  EXPECT_THAT(names(), testing::UnorderedElementsAre("run", "r", "r.html"));
}

TEST_F(ReportTest, DamagedFilesAreNamed) {
  write_run(run(), {});
  const auto message_with = [&](const char* file, const char* text) {
    const std::string before = read_text(run() / file);
    std::ofstream(run() / file) << text;
    const std::string message = refusal({.directory = run(), .out = {}});
    std::ofstream(run() / file) << before;
    return message;
  };
  EXPECT_THAT(message_with("errors.csv", "frame,mean_joint_error_mm\n0,x\n"),
              HasSubstr("errors.csv:2: column 'mean_joint_error_mm' holds 'x'"));
  EXPECT_THAT(message_with("worst_000001.jpg", "no picture"),
              HasSubstr("worst_000001.jpg: is no picture"));
  EXPECT_THAT(message_with("run.yaml", "seed: 1\n"), HasSubstr("run.yaml: has no list of models"));
  EXPECT_THAT(message_with("truth_states.csv", "frame,time\n0,0\n"),
              HasSubstr("truth_states.csv: has no column 'box.position_x'"));
  EXPECT_THAT(message_with("run.yaml", "models: [{name: box, type: no_such_model}]\n"),
              HasSubstr("no_such_model"));
}

TEST_F(ReportTest, RefusesPlacesThatNoPageCanHave) {
  write_run(run(), {});
  EXPECT_THAT(refusal({.directory = run(), .out = run()}), HasSubstr("is a folder"));
  EXPECT_THAT(refusal({.directory = run(), .out = path("page")}), HasSubstr("not end in .html"));
  fs::create_symlink("/dev/null", path("null.html"));
  EXPECT_EQ(
      refusal({.directory = run(), .out = path("null.html")}),
      path("null.html").string() + ": is a device; expected the name of an HTML file after --out");
  EXPECT_THAT(refusal({.directory = run(), .out = run() / "track.csv" / "r.html"}),
              HasSubstr("cannot be written"));
}

/// The PATH of this process while it lives.
class SearchPath {
 public:
  explicit SearchPath(const std::string& path) { setenv("PATH", path.c_str(), 1); }
  ~SearchPath() { setenv("PATH", before_.c_str(), 1); }
  SearchPath(const SearchPath&) = delete;
  SearchPath& operator=(const SearchPath&) = delete;

 private:
  std::string before_ = std::getenv("PATH");
};

TEST_F(ReportTest, SaysWhatToInstallForFilesOfThePlots) {
  write_run(run(), {});
  const SearchPath empty("/nonexistent");
  const ReportSummary summary = write_report({.directory = run(), .out = {}}, plugins_);
  EXPECT_THAT(summary.skipped, HasSubstr("install nodejs (SVG) and librsvg2-bin (PNG)"));
  EXPECT_TRUE(fs::exists(run() / "report.html"));
  const auto insist = [&] {
    write_report({.directory = run(), .out = path("r.html"), .plot_files = PlotFiles::required},
                 plugins_);
  };
  EXPECT_THAT(message_of<OutputError>(insist), HasSubstr("install nodejs"));
  EXPECT_FALSE(fs::exists(path("r.html")));
}

TEST_F(ReportTest, WritesFilesOfThePlots) {
  write_run(run(), {});
  write_study(path("study"), {.seeds = 2});
  const ReportSummary of_run = write_report({.directory = run(), .out = {}}, plugins_);
  if (!of_run.skipped.empty()) GTEST_SKIP() << of_run.skipped;
  write_report({.directory = path("study"), .out = {}}, plugins_);
  for (const char* plot :
       {"run/report/plots/error", "run/report/plots/success", "study/report/plots/plot-1-curve",
        "study/report/plots/plot-2-heatmap"}) {
    EXPECT_THAT(read_text(path(plot + std::string(".svg"))), testing::StartsWith("<svg")) << plot;
    EXPECT_THAT(read_text(path(plot + std::string(".png"))), testing::StartsWith("\x89PNG"))
        << plot;
  }
}

TEST_F(ReportTest, NeedsNoPluginWithoutReplays) {
  write_run(run(), {});
  std::ofstream(run() / "run.yaml") << "models: [{name: box, type: no_such_model}]\n";
  EXPECT_EQ(report({.directory = run(), .out = {}, .replays = 0}).replays, 0U);
}

TEST_F(ReportTest, WorksWithoutAnyTruth) {
  write_run(run(), {.truth_states = false, .truth_landmarks = false});
  EXPECT_EQ(report({.directory = run(), .out = {}}).replays, 1U);
}

TEST_F(ReportTest, ReplaysShareTheTruthAndTheShape) {
  write_run(path("a"), {.seed = 1});
  write_run(path("b"), {.seed = 2});
  ReplayCollector replays(plugins_);
  const auto a = replays.add(path("a"));
  const auto b = replays.add(path("b"));
  EXPECT_THAT(replays.shapes(), SizeIs(1));
  EXPECT_THAT(replays.motions(), SizeIs(3));
  EXPECT_EQ(a["models"][0]["truth"], b["models"][0]["truth"]);
  EXPECT_NE(a["models"][0]["tracked"], b["models"][0]["tracked"]);
}

TEST_F(ReportTest, ReplaysShowTrueLandmarksWhereStatesAreUnknown) {
  write_run(run(), {.truth_states = false});
  ReplayCollector replays(plugins_);
  const auto replay = replays.add(run());
  EXPECT_FALSE(replay["models"][0].contains("truth"));
  EXPECT_EQ(replay["truth_points"]["count"], 3);
}

TEST_F(ReportTest, LongReplaysSkipFrames) {
  write_run(run(), {.frames = 2100});
  ReplayCollector replays(plugins_);
  const auto frames = replays.add(run())["frames"];
  EXPECT_EQ(frames.size(), 700U);
  EXPECT_EQ(frames[1], 3);
}

TEST_F(ReportTest, SeriesKeepFramesThatHaveNoError) {
  write_run(run(), {.frames = 3, .lost_from = 2});
  std::ofstream(run() / "errors.csv") << "frame,time,mean_joint_error_mm\n2,0.1,7\n";
  const auto series = run_series(run());
  EXPECT_EQ(series["count"], 3);
  EXPECT_EQ(series["status"], "ttl");
  EXPECT_EQ(series["error"]["b"], "/////wAA");  // unknown, unknown, lo
  EXPECT_EQ(series["error"]["lo"], 7);
}

TEST_F(ReportTest, SeriesOfATracedRunSayWhatFailedInWhichFrame) {
  write_run(run(), {.frames = 5});
  EXPECT_FALSE(run_series(run()).contains("outcome"));
  std::ofstream(run() / "truth_costs.csv") << "frame,cost,truth_cost,mean_joint_error_mm,outcome\n"
                                              "1,0.3,0.1,5,found\n"
                                              "2,0.3,0.1,50,search_failed\n"
                                              "3,0.3,0.9,50,objective_failed\n"
                                              "4,0.3,,,\n";
  const auto series = run_series(run());
  EXPECT_EQ(series["outcome"], "-fso-");
  EXPECT_EQ(series["truth_cost"]["b"], "//8AAAAA/v///w==");  // unknown, lo, lo, high, unknown
}

TEST_F(ReportTest, NamesTheFileOfADamagedOutcome) {
  write_run(run(), {.frames = 2});
  std::ofstream(run() / "truth_costs.csv") << "frame,truth_cost,outcome\n0,1,lucky\n";
  EXPECT_THAT(message_of<DataError>([&] { run_series(run()); }),
              HasSubstr("truth_costs.csv:2: the outcome is 'lucky'; expected found, "));
}

TEST(PackedTest, IsBase64OfLittleEndianWords) {
  EXPECT_EQ(base64(std::vector<std::uint8_t>{'M', 'a', 'n'}), "TWFu");
  EXPECT_EQ(base64(std::vector<std::uint8_t>{'M', 'a'}), "TWE=");
  EXPECT_EQ(base64(std::vector<std::uint8_t>{'M'}), "TQ==");
  EXPECT_EQ(pack_words(std::vector<std::uint16_t>{0x4d61}), "YU0=");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto packed = pack_numbers(std::vector<double>{-1, nan, 3});
  EXPECT_EQ(packed["lo"], -1);
  EXPECT_DOUBLE_EQ(packed["step"], 4 / 65534.0);
  EXPECT_EQ(packed["b"], pack_words(std::vector<std::uint16_t>{0, 65535, 65534}));
}

TEST(SkeletonTest, JoinsEveryLandmarkOfAHandToTheWrist) {
  const ModelData hand = test::make_test_hand();
  const auto edges = skeleton_edges(hand);
  EXPECT_THAT(edges, SizeIs(hand.landmarks.size() - 1));
  std::vector<int> above(hand.landmarks.size(), -1);
  for (const auto& [from, to] : edges) above[static_cast<std::size_t>(to)] = from;
  EXPECT_EQ(std::count(above.begin(), above.end(), -1), 1);
}

}  // namespace
}  // namespace hypotrack
