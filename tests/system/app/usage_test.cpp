#include <sstream>

#include "app_test.hpp"
#include "plugin/capabilities.hpp"
#include "plugin/inspect.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class UsageTest : public AppTest {
 protected:
  static std::string fixture(const std::string& group, const std::string& name) {
    return (build_dir() / "tests/plugin_fixtures" / group /
            ("libhypotrack_optimizer_" + name + ".so"))
        .string();
  }
};

TEST_F(UsageTest, HelpAndVersionSucceed) {
  const Outcome help = run_program({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, AllOf(HasSubstr("run"), HasSubstr("validate"), HasSubstr("synth"),
                              HasSubstr("evaluate"), HasSubstr("bench"), HasSubstr("plugins"),
                              HasSubstr("--plugin-path")));
  const Outcome run_help = run_program({"run", "--help"});
  EXPECT_EQ(run_help.exit_code, 0);
  EXPECT_THAT(run_help.out, AllOf(HasSubstr("--set"), HasSubstr("--out"), HasSubstr("--frames"),
                                  HasSubstr("--seed")));
  const Outcome version = run_program({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, testing::ContainsRegex("hypotrack [0-9]+\\.[0-9]+.*plugin ABI"));
}

TEST_F(UsageTest, StartsWithoutTheLibrariesOfImagesAndVideos) {
  Start start;
  start.environment = {"LD_TRACE_LOADED_OBJECTS=1"};  // the loader prints what it would load
  const Outcome outcome = run_program(start);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("libhypotrack.so"), Not(HasSubstr("imgcodecs")),
                                 Not(HasSubstr("videoio")), Not(HasSubstr("avformat"))));
}

TEST_F(UsageTest, MistakesOfUsageEndWithTwo) {
  const std::vector<std::vector<std::string>> mistakes = {
      {},
      {"rum"},
      {"run"},
      {"run", "a.yaml", "--frames", "0"},
      {"run", "a.yaml", "--frames", "many"},
      {"run", "a.yaml", "--seed", "-1"},
      {"run", "a.yaml", "--no-such-option"},
      {"run", "a.yaml", "--out", ""},
      {"synth", "a.yaml"},
      {"synth", "a.yaml", "--out", ""},
      {"fit-shape", "a.yaml", "--out", ""},
      {"evaluate"},
      {"evaluate", "a", "--units", "inch"},
      {"evaluate", "a", "--out", ""},
      {"plugins"},
      {"plugins", "info"},
      {"plugins", "check"},
  };
  for (const auto& arguments : mistakes) {
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << testing::PrintToString(arguments);
    EXPECT_NE(outcome.err, "") << testing::PrintToString(arguments);
  }
}

TEST_F(UsageTest, MistakesOfUsageSayWhatIsExpected) {
  const auto message = [](const std::vector<std::string>& arguments) {
    return run_program(arguments).err;
  };
  EXPECT_THAT(message({"rum", "a.yaml"}),
              AllOf(HasSubstr("no command 'rum'; did you mean 'run'?"), HasSubstr("validate")));
  EXPECT_THAT(message({"start", "a.yaml"}), HasSubstr("no command 'start'; it is `click` now. "));
  EXPECT_THAT(message({"run", "a.yaml", "--frames", "0"}),
              HasSubstr("--frames: expected a whole number from 1 to 2147483647, found '0'"));
  EXPECT_THAT(message({"run", "a.yaml", "--frames", "1e3"}), HasSubstr("found '1e3'"));
  EXPECT_THAT(message({"run", "a.yaml", "--seed", "99999999999999999999"}),
              HasSubstr("--seed: expected a whole number from 0 to"));
  EXPECT_THAT(message({"run", "a.yaml", "--out", ""}),
              HasSubstr("--out: is empty, expected a name"));
}

TEST_F(UsageTest, ThePluginPathMayStandBeforeTheScene) {
  const Outcome outcome =
      run_program({"validate", "--plugin-path", folder().string(), scene(box_scene())});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

TEST_F(UsageTest, ChangesMayStandBeforeTheScene) {
  const std::string file = scene(box_scene());
  EXPECT_THAT(run_program({"validate", "--set", "a=b", file}).err,
              HasSubstr("--set a=b: a: unknown key. Allowed: models, source"));
  const Outcome two = run_program(
      {"run", "--set", "source.frames=2", "--set", "seed=3", file, "--out", path("out").string()});
  EXPECT_EQ(two.exit_code, 0) << two.err;
  EXPECT_THAT(read_text(path("out/run.yaml")), AllOf(HasSubstr("frames: 2"), HasSubstr("seed: 3")));
  EXPECT_THAT(run_program({"evaluate", "--rename", "a=b", path("no_run").string()}).err,
              HasSubstr("no_run"));
}

TEST_F(UsageTest, WhatCannotBePrintedIsAnError) {
  Start start;
  start.arguments = {"validate", scene(box_scene()), "--print"};
  start.out = "/dev/full";
  const Outcome outcome = run_program(start);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("No space left on device"));
}

TEST_F(UsageTest, ValidateSaysWhatTheSceneIs) {
  const std::string file = scene(box_scene());
  const Outcome outcome = run_program({"validate", file});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(file + ": ok: 1 model, 7 parameters, 2 cameras, "));
  EXPECT_THAT(names_in(folder()), testing::ElementsAre("scene.yaml"));
}

TEST_F(UsageTest, ValidatePrintsASceneThatIsValidAndPrintsTheSame) {
  const Outcome first = run_program({"validate", scene(box_scene()), "--print"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.out, AllOf(HasSubstr("beta: "), HasSubstr("seed: ")));
  const Outcome second = run_program({"validate", scene(first.out, "again.yaml"), "--print"});
  EXPECT_EQ(second.exit_code, 0) << second.err;
  EXPECT_EQ(second.out, first.out);
}

TEST_F(UsageTest, ValidateFindsAFrameThatTheObjectiveCannotWorkWith) {
  const Outcome outcome = run_program(
      {"validate", scene(replaced(box_scene(), "focal_px: 160,", "focal_px: 160, count: 1,"))});
  expect_refusal(outcome, {"stereo_color", "two"});
}

TEST_F(UsageTest, AStartOutOfViewIsPointedOut) {
  const std::string file =
      scene(replaced(box_scene(), "init: {from: truth}",
                     "init: {from: rest, pose: {box: {position_mm: [300, 0, 400]}}}"));
  const auto note = AllOf(HasSubstr("note: 0 % of what the models cover"), HasSubstr("(init)"));
  const Outcome looked_at = run_program({"validate", file});
  EXPECT_EQ(looked_at.exit_code, 0);
  EXPECT_THAT(looked_at.err, note);
  const Outcome tracked = run_program({"run", file, "--out", path("out").string()});
  EXPECT_EQ(tracked.exit_code, 0);
  EXPECT_THAT(tracked.err, note);
  EXPECT_THAT(run_program({"validate", scene(box_scene())}).err, Not(HasSubstr("note")));
}

TEST_F(UsageTest, ValidateFindsAStartThatNothingCanBeSearchedFrom) {
  const Outcome outcome =
      run_program({"validate", scene(replaced(box_scene(), "init: {from: truth}",
                                              "init: {from: rest, pose: {box: {position_mm: [0, "
                                              "0, -400]}}}"))});
  expect_refusal(outcome, {"'box' lies at or behind camera 0"});
}

TEST_F(UsageTest, PluginsAreListed) {
  const Outcome outcome = run_program({"plugins", "list"});
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* name : {"rigid_box", "stereo_color", "pso", "synthetic"})
    EXPECT_THAT(outcome.out, HasSubstr(name));
}

TEST_F(UsageTest, InfoTellsAPluginsParameters) {
  const Outcome outcome = run_program({"plugins", "info", "optimizer/pso"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("particles"), HasSubstr("generations")));
  const Outcome unknown = run_program({"plugins", "info", "psso"});
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'pso'"));
}

TEST_F(UsageTest, ModelsAreDescribedWithTheirParameters) {
  const Outcome hand = run_program({"plugins", "info", "model/hand"});
  EXPECT_EQ(hand.exit_code, 0) << hand.err;
  EXPECT_THAT(hand.out,
              AllOf(HasSubstr("degrees of freedom: 26, 6 of its pose and 20 of its joints"),
                    HasSubstr("thumb_abduction"), HasSubstr("landmarks\n  wrist, ")));
  const Outcome box =
      run_program({"plugins", "info", "rigid_box", "--set", "size_mm=[10, 20, 30]"});
  EXPECT_THAT(box.out, HasSubstr("degrees of freedom: 6, of its pose\n"));
  const Outcome unknown = run_program({"plugins", "info", "articulated"});
  EXPECT_EQ(unknown.exit_code, 0) << unknown.err;
  EXPECT_THAT(unknown.out, HasSubstr("degrees of freedom: depend on the parameters; give them with "
                                     "--set"));
  const std::string file =
      "file=" + std::string(HYPOTRACK_SOURCE_DIR) + "/configs/objects/scissors.urdf";
  const Outcome known = run_program({"plugins", "info", "articulated", "--set", file});
  EXPECT_EQ(known.exit_code, 0) << known.err;
  EXPECT_THAT(known.out, HasSubstr("degrees of freedom: 7, 6 of its pose and 1 of its joints"));
  const Outcome wrong = run_program({"plugins", "info", "rigid_box", "--set", "size_mm=red"});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.err, HasSubstr("size_mm"));
}

TEST_F(UsageTest, EveryCapabilityOfOursIsExplained) {
  int explained = 0;
  for (const PluginRow& row : list_plugins(std::vector{plugin_dir()})) {
    std::istringstream words(row.capabilities);
    for (std::string word; words >> word; ++explained)
      EXPECT_NE(find_capability(row.kind, word), nullptr)
          << row.kind << " " << row.name << ": " << word;
  }
  EXPECT_GT(explained, 20);
  EXPECT_THAT(run_program({"plugins", "capabilities"}).out,
              HasSubstr("needs_least_squares  works only if every objective has residuals\n"));
}

TEST_F(UsageTest, CheckSaysWhyAPluginCannotBeUsed) {
  const Outcome good = run_program({"plugins", "check", fixture("good", "sample")});
  EXPECT_EQ(good.exit_code, 0) << good.out;
  const Outcome other = run_program({"plugins", "check", fixture("bad", "other_abi")});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.out, HasSubstr("ABI"));
  const Outcome crash = run_program({"plugins", "check", fixture("harmful", "segfault")});
  EXPECT_EQ(crash.exit_code, 1);
  EXPECT_THAT(crash.out, HasSubstr("crash"));
}

TEST_F(UsageTest, NoHarmfulPluginEndsTheList) {
  const std::string folder = (build_dir() / "tests/plugin_fixtures/bad").string();
  const Outcome outcome = run_program({"plugins", "list", "--plugin-path", folder});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("crash_in_describe"), HasSubstr("pso")));
}

}  // namespace
}  // namespace hypotrack::test
