#include <sys/stat.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <cstring>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;

using BadInputTest = AppTest;

TEST_F(BadInputTest, MissingScene) {
  const std::string file = path("nothing.yaml").string();
  expect_refusal(run_program({"run", file, "--out", path("out").string()}), {file});
}

TEST_F(BadInputTest, NoNameOfAScene) {
  expect_refusal(run_program({"run", "", "--out", path("out").string()}), {"empty", "a YAML file"});
}

TEST_F(BadInputTest, BrokenYaml) { expect_refused("models: [{name: box\n", {"scene.yaml:2:1"}); }

TEST_F(BadInputTest, EmptyScene) { expect_refused("", {"scene.yaml", "models", "missing"}); }

TEST_F(BadInputTest, SceneThatIsNoMap) {
  expect_refused("- 1\n- 2\n", {"scene.yaml:1:1", "models, source, objective and optimizer"});
}

TEST_F(BadInputTest, AStudyIsNoScene) {
  expect_refused("title: T\nscenes: {a: {file: b.yaml}}\n",
                 {"scene.yaml:", "this is a study, no scene", "`hypotrack compare`"});
}

TEST_F(BadInputTest, UnknownKeys) {
  expect_refused(box_scene() + "sede: 3\n", {"scene.yaml:13:1", "sede", "did you mean 'seed'"});
  expect_refused(replaced(box_scene(), "particles", "particels"),
                 {"scene.yaml:9:", "particels", "did you mean 'particles'"});
}

TEST_F(BadInputTest, UnknownPlugin) {
  expect_refused(replaced(box_scene(), "type: pso", "type: psso"),
                 {"scene.yaml:9:", "there is no optimizer 'psso'", "did you mean 'pso'"});
}

TEST_F(BadInputTest, PluginOfAnotherAbi) {
  const std::string folder = (build_dir() / "tests/plugin_fixtures/bad").string();
  expect_refused(
      replaced(box_scene(), "{type: pso, particles: 8, generations: 4}", "{type: other_abi}"),
      {"libhypotrack_optimizer_other_abi.so", "ABI"}, {"--plugin-path", folder});
}

TEST_F(BadInputTest, APluginThatCrashesWhenItIsLoadedIsNamed) {
  const std::filesystem::path folder = build_dir() / "tests/plugin_fixtures/harmful";
  for (const std::string how : {"abort", "throw"}) {
    const std::string library = (folder / ("libhypotrack_optimizer_" + how + ".so")).string();
    const Outcome outcome =
        run(replaced(box_scene(), "type: pso, particles: 8, generations: 4", "type: " + how),
            {"--plugin-path", folder.string()});
    EXPECT_EQ(outcome.exit_code, 128 + SIGABRT) << how;
    EXPECT_THAT(outcome.err, HasSubstr(library + ": crashed while it was loaded"));
    EXPECT_THAT(outcome.err, HasSubstr("`hypotrack plugins check " + library + "`"));
  }
}

TEST_F(BadInputTest, ASourceThatBreaksItsContract) {
  const auto with = [](const std::string& fault) {
    std::string scene = replaced(box_scene(), "init: {from: truth}",
                                 "init: {pose: {box: {position_mm: [0, 0, 400]}}}");
    const auto begin = scene.find("source:");
    const auto end = scene.find("objective:");
    return scene.replace(begin, end - begin,
                         "source: {type: broken, frames: 5, fault: " + fault + "}\n");
  };
  const std::vector<std::string> plugins{"--plugin-path",
                                         (build_dir() / "tests/broken_plugins").string()};
  const std::string bug = "this is a bug in the source";
  expect_refused(with("no_cameras"), {"scene.yaml:2:9: source 'broken' has no camera", bug},
                 plugins);
  expect_refused(with("no_frame_rate"), {"source 'broken'", "0 frames per second", bug}, plugins);
  expect_refused(with("endless_frame_rate"), {"source 'broken'", "inf frames per second", bug},
                 plugins);
  EXPECT_THAT(
      run(with("silent_gap"), plugins).err,
      testing::ContainsRegex("frame 2: .*scene.yaml:2:9: source 'broken' gives no views and no "
                             "reason; this is a bug"));
  std::filesystem::remove_all(path("out"));
  expect_refused(with("truth_of_another_scene"),
                 {"source 'broken', frame 0", "5 numbers in the true state, the scene has 7", bug},
                 plugins);
  expect_refused(with("landmarks_of_another_scene"),
                 {"source 'broken', frame 0", "2 true landmarks, the scene has 3", bug}, plugins);
}

TEST_F(BadInputTest, ASourceWhoseTimeStandsStillIsTrackedInItsFrameRate) {
  std::string scene = replaced(box_scene(), "init: {from: truth}",
                               "init: {pose: {box: {position_mm: [0, 0, 400]}}}");
  const auto begin = scene.find("source:");
  scene.replace(begin, scene.find("objective:") - begin,
                "source: {type: broken, frames: 5, fault: time_stands_still}\n");
  const Outcome outcome =
      run(scene, {"--plugin-path", (build_dir() / "tests/broken_plugins").string(), "--set",
                  "status.check_pictures=false"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("note: frame 1: its time is not after that of the frame"));
  EXPECT_THAT(read_text(path("out/summary.json")), HasSubstr("\"time_back\": 4"));
  const auto rows = lines_of(read_text(path("out/track.csv")));
  EXPECT_EQ(rows[2].substr(0, 7), "1,0.04,");
  EXPECT_EQ(rows[5].substr(0, 7), "4,0.16,");
  EXPECT_THAT(rows[5], testing::EndsWith(",time_back"));
}

TEST_F(BadInputTest, ValuesOutOfRange) {
  expect_refused(replaced(box_scene(), "particles: 8", "particles: 0"),
                 {"scene.yaml:9:", "0 is out of range"});
  expect_refused(replaced(box_scene(), "[20, 10, 420]", "[1e9, 10, 420]"),
                 {"scene.yaml:7:", "1e9 is out of range"});
  expect_refused(box_scene() + "seed: -1\n", {"scene.yaml:13:", "-1 is out of range"});
  expect_refused(box_scene(), {"--set optimizer.particles=no", "expected an integer"},
                 {"--set", "optimizer.particles=no"});
}

TEST_F(BadInputTest, APipeThatNobodyWritesInto) {
  const std::string pipe = path("pipe.yaml").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  expect_refusal(run_program({"run", pipe, "--out", path("out").string()}),
                 {pipe + ": is a pipe that nobody writes into; expected a YAML file"});
}

TEST_F(BadInputTest, ADeviceAsATable) {
  expect_refused(
      replaced(box_scene(), "init: {from: truth}", "init: {from: file, file: /dev/zero}"),
      {"/dev/zero: is a device; expected a CSV table"});
}

TEST_F(BadInputTest, APluginFolderThatIsNotThere) {
  const Outcome outcome = run(box_scene(), {"--plugin-path", path("nowhere").string()});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("there is no folder '" + path("nowhere").string() + "'"));
}

TEST_F(BadInputTest, ModelNamesThatTablesAndOptionsCannotHold) {
  for (const char* name : {"a=b", "a<b", "a/b", "a\\tb", "a.b", "a b"})
    expect_refused(replaced(box_scene(), "name: box", "name: \"" + std::string(name) + "\""),
                   {"scene.yaml:1:", "holds other characters than letters, digits, '_' and '-'"});
}

TEST_F(BadInputTest, APathThatRunYamlCouldNotHold) {
  const std::filesystem::path folder = path("caf\xE9");
  std::filesystem::create_directory(folder);
  ASSERT_EQ(run_program({"synth", scene(box_scene()), "--out", (folder / "recording").string()})
                .exit_code,
            0);
  expect_refusal(
      run_program(
          {"run", (folder / "recording/scene.yaml").string(), "--out", path("out").string()}),
      {"caf?/recording", "is no UTF-8, which run.yaml cannot hold", "rename the file or folder"});
}

TEST_F(BadInputTest, AnObjectiveWithoutWeight) {
  const std::string refused = "every pose costs the same; give one a weight above 0";
  expect_refused(replaced(box_scene(), "{type: stereo_color}", "{type: stereo_color, weight: 0}"),
                 {"scene.yaml:8:12: objective: the weight of its only term is 0", refused});
  expect_refused(replaced(box_scene(), "{type: stereo_color}",
                          "[{type: stereo_color, weight: 0}, {type: stereo_color, weight: 0.0}]"),
                 {"scene.yaml:8:12: objective: the weight of each of its terms is 0", refused});
  const Outcome one = run(replaced(box_scene(), "{type: stereo_color}",
                                   "[{type: stereo_color, weight: 0}, {type: stereo_color}]"));
  EXPECT_EQ(one.exit_code, 0) << one.err;
}

TEST_F(BadInputTest, NoModels) {
  expect_refused(
      replaced(box_scene(), "[{name: box, type: rigid_box, size_mm: [90, 60, 40]}]", "[]"),
      {"scene.yaml:1:", "at least one"});
}

TEST_F(BadInputTest, AModelWithoutAName) {
  expect_refused(replaced(box_scene(), "name: box,", "name: ,"), {"scene.yaml:1:", "name"});
}

TEST_F(BadInputTest, TwoModelsOfOneName) {
  expect_refused(replaced(box_scene(), "[90, 60, 40]}]",
                          "[90, 60, 40]}, {name: box, type: "
                          "rigid_box}]"),
                 {"scene.yaml:1:", "two models are called 'box'", "name"});
}

TEST_F(BadInputTest, LeastSquaresOnAnObjectiveWithoutResiduals) {
  const std::string folder = (build_dir() / "tests/plugin_fixtures/app").string();
  const std::string least_squares = replaced(
      box_scene(), "{type: pso, particles: 8, generations: 4}", "{type: levenberg_marquardt}");
  for (const char* objective :
       {"{type: failing}", "[{type: stereo_color}, {type: failing}]", "[{type: failing}]"})
    expect_refused(replaced(least_squares, "{type: stereo_color}", objective),
                   {"objective failing", "offers no residuals", "optimizer: {type: pso}"},
                   {"--plugin-path", folder});
}

TEST_F(BadInputTest, StereoObjectiveOnOneCamera) {
  expect_refused(replaced(box_scene(), "focal_px: 160,", "focal_px: 160, count: 1,"),
                 {"stereo_color", "two"});
}

TEST_F(BadInputTest, StartOutsideTheBounds) {
  const std::string hand = replaced(box_scene(), "init: {from: truth}",
                                    "init: {from: rest, pose: {box: {angles_deg: "
                                    "{index_flexion_1: 300}}}}");
  expect_refused(replaced(hand, "type: rigid_box, size_mm: [90, 60, 40]", "type: hand"),
                 {"scene.yaml:11:", "300 is out of range"});
}

TEST_F(BadInputTest, StartOfATableOutsideTheBounds) {
  write_text(path("states.csv"),
             "frame,time,position_x,position_y,position_z,rotation_w,rotation_x,rotation_y,"
             "rotation_z\n3,0,nan,0,0.4,1,0,0,0\n");
  const auto with = [](const std::string& init) {
    return replaced(box_scene(), "init: {from: truth}", "init: {" + init + "}");
  };
  expect_refused(with("from: file, file: states.csv"), {"states.csv:2", "finite"});
  expect_refused(with("from: global_search, pose: {box: {position_mm: [0, 0, 400]}}"),
                 {"scene.yaml:11:", "leave one of them out"});
  expect_refused(with("from: file"), {"scene.yaml:11:", "init.file names none"});
  expect_refused(with("from: file, file: missing.csv"), {"missing.csv", "no such file"});
  expect_refused(with("from: {type: file}"), {"scene.yaml:11:", "init.from.file: required key"});
  expect_refused(with("from: landmarks"), {"scene.yaml:11:14: init.from.file: required key"});
  expect_refused(with("from: trut"),
                 {"scene.yaml:11:14: ", "there is no starter 'trut'; did you mean 'truth'?"});
}

TEST_F(BadInputTest, StartBehindTheCameras) {
  expect_refused(replaced(box_scene(), "init: {from: truth}",
                          "init: {from: rest, pose: {box: {position_mm: [0, 0, -400]}}}"),
                 {"'box' lies at or behind camera 0"});
}

TEST_F(BadInputTest, BadMeshes) {
  const auto with = [](const std::string& mesh) {
    return replaced(box_scene(), "type: rigid_box, size_mm: [90, 60, 40]",
                    "type: rigid_mesh, mesh: " + mesh);
  };
  write_text(path("points.obj"), "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\n");
  expect_refused(with("points.obj"), {"points.obj"});
  write_text(path("nan.obj"), "v 0 0 0\nv nan 0 0\nv 0 0.1 0\nf 1 2 3\n");
  expect_refused(with("nan.obj"), {"nan.obj"});
  expect_refused(with("missing.obj"), {"missing.obj"});
}

TEST_F(BadInputTest, WithoutACalibrationItIsSaidWhatIsMissing) {
  for (const char* source : {"{type: image_sequence, left: l_%d.png, right: r_%d.png}",
                             "{type: video, left: l.mp4, right: r.mp4}", "{type: rgbd, folder: .}"})
    expect_refused(box_scene(), {"source.calibration: required key is missing"},
                   {"--set", std::string("source=") + source});
}

TEST_F(BadInputTest, ABudgetOfBothClocks) {
  expect_refused(box_scene() + "budget: {seconds: 1, cpu_seconds: 1}\n",
                 {"scene.yaml:13:35: budget.cpu_seconds: the budget has `seconds` of wall time too",
                  "give one of them"});
}

TEST_F(BadInputTest, OutputFolderUnderAFile) {
  write_text(path("file"), "");
  const std::string out = path("file/out").string();
  expect_refusal(run_program({"run", scene(box_scene()), "--out", out}),
                 {out, "the output folder cannot be made", "--out"});
}

TEST_F(BadInputTest, OutputFolderIsAFile) {
  const std::string out = path("file").string();
  write_text(out, "mine");
  expect_refusal(run_program({"run", scene(box_scene()), "--out", out}),
                 {out, "cannot be made", "--out"});
  EXPECT_EQ(read_text(out), "mine");
}

TEST_F(BadInputTest, OutputFolderThatNobodyCanWrite) {
  const std::string out = "/proc/hypotrack_results";
  expect_refusal(run_program({"run", scene(box_scene()), "--out", out}), {out, "--out"});
}

TEST_F(BadInputTest, AFolderInAResultsPlaceIsFoundBeforeTheRun) {
  const auto in_the_way = path("results/summary.json");
  std::filesystem::create_directories(in_the_way);
  expect_refusal(run_program({"run", scene(box_scene()), "--out", path("results").string()}),
                 {in_the_way.string(), "is a folder", "--out"});
  EXPECT_THAT(names_in(path("results")), testing::ElementsAre("summary.json"));
}

TEST_F(BadInputTest, WithoutMp4NothingIsWrittenAndTheWayOutIsSaid) {
  Start start;
  start.arguments = {"run", scene(replaced(box_scene(), "overlay: false", "overlay: true")),
                     "--out", path("out").string()};
  start.environment = {"LD_PRELOAD=" + (build_dir() / "tests/support/no_encoders.so").string()};
  expect_refusal(run_program(start),
                 {"overlay.mp4", "neither H.264 nor MPEG-4", "--set output.overlay=false"});
}

TEST_F(BadInputTest, AFullDiskOrALimitOnFileSizesIsReportedAndLeavesNoFinishedRun) {
  Start start;
  start.arguments = {"run", scene(box_scene()), "--out", path("out").string()};
  start.largest_file = 4096;
  start.arguments.insert(start.arguments.end(), {"--set", "source.frames=60"});
  const Outcome outcome = run_program(start);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("cannot be written: File too large"));
  EXPECT_THAT(outcome.err, HasSubstr("Make room"));
  EXPECT_THAT(outcome.err, HasSubstr(path("out/track.csv").string()));
  EXPECT_THAT(names_in(path("out")), testing::Not(testing::Contains("summary.json")));
  EXPECT_THAT(read_text(path("out/track.csv")), testing::EndsWith("\n"));
}

}  // namespace
}  // namespace hypotrack::test
