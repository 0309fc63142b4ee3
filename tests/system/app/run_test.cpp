#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/videoio.hpp>
#include <sstream>

#include "app_test.hpp"
#include "hypotrack/api/media.hpp"

namespace hypotrack::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

class RunTest : public AppTest {
 protected:
  /// The rows of a table, without its header; a status is 0.
  static std::vector<std::vector<double>> numbers_in(const std::filesystem::path& file) {
    std::vector<std::vector<double>> rows;
    for (const std::string& line : lines_of(read_text(file))) {
      if (line.starts_with("frame,")) continue;
      rows.emplace_back();
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');)
        rows.back().push_back(std::isalpha(cell[0]) && cell != "nan" ? 0 : std::stod(cell));
    }
    return rows;
  }
};

TEST_F(RunTest, ABudgetOfCpuTimeEndsSearchesWithoutEnd) {
  const Outcome outcome = run(
      replaced(box_scene(), "{type: pso, particles: 8, generations: 4}", "{type: random_search}") +
          "budget: {evaluations: 1000000000000, cpu_seconds: 0.01}\n",
      {"--frames", "2"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(3));
}

TEST_F(RunTest, WritesEveryResultOfASceneWithTruth) {
  const Outcome outcome = run(replaced(box_scene(), "overlay: false", "overlay: true"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(names_in(path("out")),
              ElementsAre("errors.csv", "joints.csv", "metrics.json", "overlay.mp4", "run.yaml",
                          "summary.json", "track.csv", "truth_landmarks.csv", "truth_states.csv",
                          testing::MatchesRegex("worst_[0-4]\\.jpg")));
  const auto track = lines_of(read_text(path("out/track.csv")));
  ASSERT_THAT(track, SizeIs(6));
  EXPECT_THAT(track[0], StartsWith("frame,time,status,cost,evaluations,milliseconds,probability,"
                                   "box.position_x,box.position_y,box.position_z,"));
  EXPECT_THAT(track[1], StartsWith("0,0,"));
  EXPECT_THAT(lines_of(read_text(path("out/joints.csv"))), SizeIs(6));
  const auto errors = lines_of(read_text(path("out/errors.csv")));
  ASSERT_THAT(errors, SizeIs(6));
  EXPECT_EQ(errors[0], "frame,time,status,mean_joint_error_mm,box");

  cv::VideoCapture video(path("out/overlay.mp4").string());
  ASSERT_TRUE(video.isOpened());
  EXPECT_EQ(video.get(cv::CAP_PROP_FRAME_WIDTH), 160);
  EXPECT_EQ(video.get(cv::CAP_PROP_FRAME_HEIGHT), 120);
  EXPECT_EQ(video.get(cv::CAP_PROP_FPS), 30);
  int frames = 0;
  for (cv::Mat image; video.read(image); ++frames) EXPECT_FALSE(image.empty());
  EXPECT_EQ(frames, 5);
}

TEST_F(RunTest, SummaryHasThePromisedKeys) {
  ASSERT_EQ(run(box_scene()).exit_code, 0);
  const auto summary = nlohmann::json::parse(read_text(path("out/summary.json")));
  EXPECT_EQ(summary.at("complete"), true);
  EXPECT_EQ(summary.at("frames"), 5);
  for (const char* key : {"fps", "evaluations_per_second"})
    EXPECT_GT(summary.at(key).get<double>(), 0) << key;
  for (const char* key : {"lost_frames", "tracked_frames", "uncertain_frames", "said_lost_frames",
                          "absent_frames", "missing_frames"})
    EXPECT_TRUE(summary.at(key).is_number_integer()) << key;
  const auto metrics = nlohmann::json::parse(read_text(path("out/metrics.json")));
  EXPECT_EQ(summary.at("mean_joint_error_mm"), metrics.at("mean_error_mm"));
  EXPECT_EQ(summary.at("median_joint_error_mm"), metrics.at("median_error_mm"));
  EXPECT_EQ(summary.at("fraction_below_10mm"), metrics.at("success_10mm"));
  EXPECT_EQ(summary.at("lost_frames"), metrics.at("lost_frames"));
  EXPECT_GT(summary.at("median_joint_error_mm").get<double>(), 0);
  double last = 0;
  for (const char* key : {"fraction_below_5mm", "fraction_below_10mm", "fraction_below_20mm",
                          "fraction_below_40mm"}) {
    const auto fraction = summary.at(key).get<double>();
    EXPECT_GE(fraction, last) << key;
    EXPECT_LE(fraction, 1) << key;
    last = fraction;
  }
}

TEST_F(RunTest, ErrorsAndMetricsAreThoseOfTheTables) {
  ASSERT_EQ(run(box_scene()).exit_code, 0);
  const auto joints = numbers_in(path("out/joints.csv"));
  const auto truth = numbers_in(path("out/truth_landmarks.csv"));
  const auto errors = numbers_in(path("out/errors.csv"));
  ASSERT_THAT(joints, SizeIs(5));
  ASSERT_THAT(truth, SizeIs(5));
  ASSERT_THAT(errors, SizeIs(5));
  double sum = 0;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    double frame_sum = 0;
    for (std::size_t k = 2; k < 11; k += 3)  // frame, time, then three anchors
      frame_sum += 1000 * std::hypot(joints[i][k] - truth[i][k], joints[i][k + 1] - truth[i][k + 1],
                                     joints[i][k + 2] - truth[i][k + 2]);
    EXPECT_NEAR(errors[i][3], frame_sum / 3, 1e-4);
    EXPECT_EQ(errors[i][4], errors[i][3]);  // the only model
    sum += frame_sum / 3;
  }
  const auto metrics = nlohmann::json::parse(read_text(path("out/metrics.json")));
  EXPECT_NEAR(metrics.at("mean_error_mm").get<double>(), sum / 5, 1e-9);
  EXPECT_NEAR(metrics.at("models").at("box").get<double>(), sum / 5, 1e-9);
  EXPECT_THAT(metrics.at("landmarks"), SizeIs(3));
}

TEST_F(RunTest, EveryNumberPrintedIsThatOfItsFile) {
  // Some errors are below 5 mm, some between 5 and 10 mm, some above.
  const Outcome outcome = run(box_scene(), {"--set", "recovery.enabled=false"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json_of = [&](const char* name) {
    return nlohmann::json::parse(read_text(path("out") / name));
  };
  const auto metrics = json_of("metrics.json"), summary = json_of("summary.json");
  const auto number = [](const nlohmann::json& json, const char* key) {
    return json.at(key).get<double>();
  };
  int below_10 = 0;
  const auto errors = numbers_in(path("out/errors.csv"));
  for (const auto& row : errors) below_10 += row[3] < 10;
  EXPECT_EQ(number(metrics, "success_10mm"), below_10 / static_cast<double>(errors.size()));
  ASSERT_NE(number(metrics, "success_10mm"), number(metrics, "success_5mm"));
  EXPECT_THAT(
      outcome.out,
      HasSubstr(fmt::format(
          "{} frames ({} tracked, {} uncertain, {} lost, {} absent, {} missing) at {:.1f} fps "
          "({:.1f} by the clock), {:.0f} evaluations/s, {}\n",
          summary.at("frames").get<int>(), summary.at("tracked_frames").get<int>(),
          summary.at("uncertain_frames").get<int>(), summary.at("said_lost_frames").get<int>(),
          summary.at("absent_frames").get<int>(), summary.at("missing_frames").get<int>(),
          number(summary, "fps"), number(summary.at("clock"), "fps"),
          number(summary, "evaluations_per_second"), summary.at("backend").get<std::string>())));
  EXPECT_THAT(outcome.out,
              HasSubstr(fmt::format(
                  "joint error: mean {:.2f} mm, median {:.2f} mm, 95 % below "
                  "{:.2f} mm, {:.1f} % of the frames below 10 mm\n",
                  number(metrics, "mean_error_mm"), number(metrics, "median_error_mm"),
                  number(metrics, "p95_error_mm"), 100 * number(metrics, "success_10mm"))));
  EXPECT_THAT(outcome.out,
              HasSubstr(fmt::format("tracked: {:.2f} % of these frames are off by more than 20 mm",
                                    100 * number(metrics, "false_tracked_share"))));
  EXPECT_THAT(outcome.out,
              HasSubstr(fmt::format("within 10 mm: {:.1f} % of these frames are tracked",
                                    100 * number(metrics, "right_tracked_share"))));
}

TEST_F(RunTest, TrueStatesAreThoseOfTheScene) {
  ASSERT_EQ(run(box_scene()).exit_code, 0);
  const auto states = numbers_in(path("out/truth_states.csv"));
  ASSERT_THAT(states, SizeIs(5));
  EXPECT_DOUBLE_EQ(states[0][4], 0.4);  // frame, time, x, y, z
  EXPECT_DOUBLE_EQ(states[4][2], 0.02);
}

TEST_F(RunTest, TheWorstFrameIsDrawnUnlessItShouldNotBe) {
  ASSERT_EQ(run(box_scene()).exit_code, 0);
  const auto errors = numbers_in(path("out/errors.csv"));
  const auto worst = std::max_element(errors.begin(), errors.end(),
                                      [](const auto& a, const auto& b) { return a[3] < b[3]; });
  const cv::Mat picture =
      read_image(path("out/worst_" + std::to_string(worst - errors.begin()) + ".jpg").string());
  ASSERT_FALSE(picture.empty());
  EXPECT_EQ(std::max(picture.cols, picture.rows - 56), 640);  // enlarged, over a legend
  ASSERT_EQ(run(box_scene(), {"--set", "output.worst_frames=0"}).exit_code, 0);
  EXPECT_THAT(names_in(path("out")), testing::Not(testing::Contains(StartsWith("worst_"))));
}

TEST_F(RunTest, SaysWhatItDid) {
  const Outcome outcome = run(box_scene());
  EXPECT_THAT(outcome.out,
              HasSubstr("5 frames (5 tracked, 0 uncertain, 0 lost, 0 absent, 0 missing) at "));
  EXPECT_THAT(outcome.out, HasSubstr("joint error: mean "));
  EXPECT_THAT(outcome.out, HasSubstr("results in " + path("out").string()));
  EXPECT_THAT(outcome.err, HasSubstr("5/5 frames, "));
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("\x1b")));  // no bar where there is no terminal
}

TEST_F(RunTest, SaysOnceThatThePicturesContradictAStart) {
  const std::string elsewhere =
      replaced(box_scene(), "init: {from: truth}",
               "init: {pose: {box: {position_mm: [0, 60, 500], rotation_deg: [90, 0, 0]}}}");
  const auto notes = [](const Outcome& outcome) {
    return std::ranges::count_if(lines_of(outcome.err), [](const std::string& line) {
      return line.starts_with("note: frame 0: judged by the pictures, the pose found from the ");
    });
  };
  EXPECT_EQ(notes(run(elsewhere)), 1);
  EXPECT_EQ(notes(run(elsewhere, {"--set", "judge=none"})), 0);
  EXPECT_EQ(notes(run(box_scene())), 0);
}

TEST_F(RunTest, FramesEndsEarlyAndIsComplete) {
  ASSERT_EQ(run(box_scene(), {"--frames", "2"}).exit_code, 0);
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(3));
  const auto summary = nlohmann::json::parse(read_text(path("out/summary.json")));
  EXPECT_EQ(summary.at("frames"), 2);
  EXPECT_EQ(summary.at("complete"), true);
}

TEST_F(RunTest, MoreFramesThanThereAreIsAllOfThem) {
  ASSERT_EQ(run(box_scene(), {"--frames", "50"}).exit_code, 0);
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(6));
}

TEST_F(RunTest, ASecondRunReplacesTheResultsAndDropsThoseItDoesNotHave) {
  ASSERT_EQ(run(replaced(box_scene(), "overlay: false", "overlay: true")).exit_code, 0);
  write_text(path("out/notes.txt"), "mine");
  ASSERT_EQ(run(box_scene(), {"--frames", "1"}).exit_code, 0);
  EXPECT_THAT(names_in(path("out")),
              ElementsAre("errors.csv", "joints.csv", "metrics.json", "notes.txt", "run.yaml",
                          "summary.json", "track.csv", "truth_landmarks.csv", "truth_states.csv",
                          "worst_0.jpg"));
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(2));
}

TEST_F(RunTest, ASceneIsNotReplacedByItsRun) {
  write_text(path("run.yaml"), box_scene());
  Start start;
  start.arguments = {"run", path("run.yaml").string(), "--out", folder()};
  EXPECT_THAT(run_program(start).err, HasSubstr("run.yaml: the run would replace this scene"));
  EXPECT_EQ(read_text(path("run.yaml")), box_scene());
}

TEST_F(RunTest, WithoutOutResultsAreInAFolderOfTheWorkingDirectory) {
  Start start;
  start.arguments = {"run", scene(box_scene()), "--frames", "1"};
  start.directory = folder();
  ASSERT_EQ(run_program(start).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(path("out/track.csv")));
}

TEST_F(RunTest, TracksWithOneDepthCamera) {
  const Outcome outcome =
      run(box_scene(), {"--set", "source.cameras.count=1", "--set", "source.depth=true", "--set",
                        "objective={type: rgbd_depth}", "--set", "output.overlay=true"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(6));
  EXPECT_TRUE(std::filesystem::exists(path("out/overlay.mp4")));
}

TEST_F(RunTest, StereoColorSaysThatItNeedsTwoCameras) {
  expect_refused(box_scene(), {"has 1 view; expected two calibrated views"},
                 {"--set", "source.cameras.count=1", "--set", "source.depth=true"});
}

/// The column `evaluations`, the fifth, of a table of states.
std::vector<int> evaluations_in(const std::filesystem::path& table) {
  std::vector<int> column;
  std::vector<std::string> lines = lines_of(read_text(table));
  for (std::size_t i = 1; i < lines.size(); ++i) {
    std::istringstream line(lines[i]);
    std::string field;
    for (int k = 0; k < 5; ++k) std::getline(line, field, ',');
    column.push_back(std::stoi(field));
  }
  return column;
}

TEST_F(RunTest, FixedLagSmoothingLeavesWhatWasFoundBesideTheTables) {
  const std::string file = scene(box_scene());
  const auto track = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{
        "run",   file,        "--out", path(out).string(), "--set", "search.rotation_as=tangent",
        "--set", "judge=none"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  };
  track("plain", {"--set", "budget.evaluations=36"});
  track("smooth", {"--set", "budget.evaluations=72", "--set", "smoothing.fixed_lag.enabled=true",
                   "--set", "smoothing.fixed_lag.evaluations=36"});
  EXPECT_THAT(names_in(path("smooth")),
              ElementsAre("errors.csv", "joints.csv", "metrics.json", "online.csv",
                          "online_joints.csv", "run.yaml", "summary.json", "track.csv",
                          "truth_landmarks.csv", "truth_states.csv"));
  std::filesystem::create_directory(path("online"));
  std::filesystem::copy(path("smooth/online.csv"), path("online/track.csv"));
  EXPECT_EQ(track_without_times(path("online")), track_without_times(path("plain")));
  EXPECT_EQ(read_text(path("smooth/online_joints.csv")), read_text(path("plain/joints.csv")));
  EXPECT_NE(read_text(path("smooth/joints.csv")), read_text(path("plain/joints.csv")));
  const std::vector<int> online = evaluations_in(path("smooth/online.csv"));
  const std::vector<int> settled = evaluations_in(path("smooth/track.csv"));
  ASSERT_THAT(settled, SizeIs(5));
  ASSERT_EQ(online.size(), settled.size());
  for (std::size_t i = 0; i < settled.size(); ++i) {
    EXPECT_GT(settled[i], online[i]) << "frame " << i;
    EXPECT_LE(settled[i], 72) << "frame " << i;
  }
}

TEST_F(RunTest, FixedLagSmoothingIsRefusedWhereItCannotWork) {
  expect_refused(box_scene(),
                 {"fixed-lag smoothing takes 128 evaluations", "which is 32",
                  "budget.evaluations 256 or more", "leave smoothing.fixed_lag.enabled off"},
                 {"--set", "smoothing.fixed_lag.enabled=true"});
  const std::vector<std::string> on{"--set", "smoothing.fixed_lag.enabled=true", "--set",
                                    "budget.evaluations=1024"};
  expect_refused(
      replaced(box_scene(), "{type: stereo_color}", "{type: stereo_color, aggregation: mean_seen}"),
      {"fixed-lag smoothing needs residuals", "objective stereo_color", "offers no residuals"}, on);
  expect_refused(box_scene() + "uncertainty: {enabled: true}\n",
                 {"smoothing.fixed_lag.enabled and uncertainty.enabled", "switch one of them off"},
                 on);
}

TEST_F(RunTest, TheOldKeyOfFixedLagSmoothingIsRefusedWithTheNewOne) {
  const std::string found = "found the key 'hindsight'", write = "write `smoothing: {fixed_lag:";
  expect_refused(box_scene() + "hindsight: {enabled: true}\n", {"scene.yaml:", found, write});
  expect_refused(box_scene(), {"--set hindsight.enabled=true", found, write},
                 {"--set", "hindsight.enabled=true"});
}

TEST_F(RunTest, KeysOfAStartFromAFileAreRefusedBesideAMap) {
  expect_refused(box_scene(), {"init.file and init.frame belong to `from: file`"},
                 {"--set", "init.from={type: truth}", "--set", "init.frame=2"});
}

TEST_F(RunTest, SetChangesKeysOfTheScene) {
  const Outcome outcome =
      run(box_scene(),
          {"--set", "optimizer.particles=5", "--set", "optimizer={type: random_search}", "--set",
           "budget.evaluations=20", "--set", "recovery.first_restarts=1", "--frames", "1"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(read_text(path("out/run.yaml")), HasSubstr("type: random_search"));
  EXPECT_THAT(lines_of(read_text(path("out/track.csv")))[1], HasSubstr(",20,"));  // evaluations
}

}  // namespace
}  // namespace hypotrack::test
