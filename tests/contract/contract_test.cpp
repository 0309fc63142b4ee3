// Tests that the contract program notices every way of breaking a contract, and names it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>
#include <vector>

#include "base/subprocess.hpp"
#include "device.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct Outcome {
  int status = -1;
  std::string output;
};

Outcome run(const std::vector<std::string>& arguments) {
  const Captured captured =
      capture_output({HYPOTRACK_CONTRACT_TEST, arguments}, {STDOUT_FILENO, STDERR_FILENO});
  return {captured.end.code, captured.output};
}

std::string library(const std::string& kind) {
  return std::string(HYPOTRACK_BROKEN_PLUGINS) + "/libhypotrack_" + kind + "_broken.so";
}

Outcome run(const std::string& kind, const std::string& parameters) {
  const test::TemporaryDirectory folder;
  const auto file = folder.path() / "parameters.yaml";
  std::ofstream(file) << parameters;
  return run({kind, library(kind), file.string()});
}

struct Case {
  std::string kind;
  std::string fault = "";
  std::string row = "";      ///< the row that fails
  std::string message = "";  ///< expected message
  std::string more = "";     ///< more parameters
};

void PrintTo(const Case& c, std::ostream* os) { *os << c.kind << " that " << c.fault; }

class Contract : public ::testing::TestWithParam<Case> {};

TEST_P(Contract, OneFaultFailsItsRow) {
  const Case& c = GetParam();
  const Outcome outcome = run(c.kind, "fault: " + c.fault + "\n" + c.more);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output, HasSubstr(c.row + ": FAILED\n"));
  EXPECT_THAT(outcome.output, HasSubstr(c.message));
}

const std::string kFrames = "frames: 6\n";
const std::string kFramesRow = "it yields frames, with a picture of the right size for each camera";
const std::string kItself = "poses_itself: true\n";
const std::string kResidualRow = "residuals are finite, complete and the same from several threads";
const std::string kSquaresRow = "the sum of squared residuals rises and falls with the cost";

INSTANTIATE_TEST_SUITE_P(
    Optimizer, Contract,
    ::testing::Values(
        Case{"optimizer", "starts_elsewhere", "the start is evaluated first",
             "in 1 dimensions with a budget of 1: the first point evaluated is not the region's"},
        Case{"optimizer", "overspends", "the budget of evaluations is kept",
             "with a budget of 1: evaluated 2 points"},
        Case{"optimizer", "miscounts", "evaluations are counted", "reported 2 evaluations, made 1"},
        Case{"optimizer", "leaves_the_bounds", "all points are within the bounds",
             "expected within ["},
        Case{"optimizer", "returns_the_last_point", "the best point evaluated is returned",
             "the returned point is not the one of the best cost"},
        Case{"optimizer", "ignores_the_seed", "equal seeds give equal searches", "took two ways"},
        Case{"optimizer", "swallows_exceptions", "exceptions of the cost pass through",
             "an exception of the cost disappeared"},
        Case{"optimizer", "ignores_time", "a budget of time ends the search",
             "a budget of 0 seconds did not end the search"},
        Case{"optimizer", "hardly_searches", "random search is worse at equal evaluations",
             "on a sphere in 27 dimensions"}),
    [](const auto& each) { return each.param.fault; });

INSTANTIATE_TEST_SUITE_P(
    Objective, Contract,
    ::testing::Values(
        Case{"objective", "nan_where_nothing_is_covered",
             "costs are numbers or +infinity, whatever the depth",
             "nothing covered, a rectified pair: the objective: the cost of a "
             "hypothesis is "},
        Case{"objective", "overflows_on_noise",
             "costs are numbers or +infinity, whatever the depth",
             "depth that is noise, a rectified pair: the objective: the cost of a "
             "hypothesis is -inf"},
        Case{"objective", "remembers", "costs do not depend on what was scored before",
             "the cost depends on what was scored before"},
        Case{"objective", "depends_on_the_thread", "several threads score the same",
             "four threads scoring at once differ from one"},
        Case{"objective", "depends_on_the_object", "a second object scores the same",
             "two objects give two costs"},
        Case{"objective", "never_repeats", "scoring twice gives the same",
             "scoring twice gives two costs"},
        Case{"objective", "refuses_everything",
             "it takes observations in or refuses them with a DataError",
             "it refuses every observation"},
        Case{"objective", "needs_a_first_frame", "it can take in a frame after a frame",
             "the cost of a hypothesis is nan"},
        Case{"objective", "infinite_residual", kResidualRow,
             "nothing covered, a rectified pair: the objective: its residuals have inf "
             "in place 0 of 2"},
        Case{"objective", "has_no_residuals", "it has what its capabilities claim",
             "they claim residuals, and residual_term() is null"},
        Case{"objective", "leaves_residuals_out", kResidualRow,
             "a rectified pair: not all of them are written: residual 1 keeps what "
             "was there. residual_count() says 2"},
        Case{"objective", "writes_too_many_residuals", kResidualRow,
             "a rectified pair: more residuals are written than residual_count(), "
             "which is 2"},
        Case{"objective", "scales_residuals", kSquaresRow,
             "from state to state the sum changes by 49.0"},
        Case{"objective", "residuals_that_ignore_the_cost", kSquaresRow,
             "from state to state the sum changes by 0.0"},
        Case{"objective", "other_residuals_with_the_cost",
             "cost and residuals are the same when asked for at once",
             "a rectified pair: residual 0 is 2.000000, and write_residuals() writes "
             "1.000000"},
        Case{"objective", "throws_a_stranger",
             "it takes observations in or refuses them with a DataError",
             "prepare() threw another exception: no luck. Throw hypotrack::DataError "
             "where an observation does not suit"}),
    [](const auto& each) { return each.param.fault; });

Outcome run_prior(const std::string& fault) {
  const test::TemporaryDirectory folder;
  const auto file = folder.path() / "parameters.yaml";
  std::ofstream(file) << "fault: " + fault + "\n";
  return run({"objective",
              std::string(HYPOTRACK_BROKEN_PLUGINS) + "/libhypotrack_objective_broken_prior.so",
              file.string()});
}

const std::string kJacobianRow = "Jacobians are those of the residuals";

class JacobianContract : public ::testing::TestWithParam<Case> {};

TEST_P(JacobianContract, OneFaultNamesTheResidualAndTheParameter) {
  const Outcome outcome = run_prior(GetParam().fault);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output, HasSubstr(GetParam().row + ": FAILED\n"));
  EXPECT_THAT(outcome.output, HasSubstr(GetParam().message)) << outcome.output;
}

INSTANTIATE_TEST_SUITE_P(
    Objective, JacobianContract,
    ::testing::Values(
        Case{"objective", "wrong_sign", kJacobianRow,
             "the scene at rest, a rectified pair: the Jacobian says -1 for residual 0 by "
             "'hand.position_z' (number 2 of the state), but differences of residuals are 1"},
        Case{"objective", "forgets_a_parameter", kJacobianRow,
             "the Jacobian says 0 for residual 2 by 'hand.thumb_flexion_2' (number 9 of the "
             "state), but differences of residuals are -1"},
        Case{"objective", "transposed", kJacobianRow,
             "its Jacobian is 27 x 3, expected 3 x 27 (residuals x numbers of the state)"},
        Case{"objective", "infinite_jacobian", kJacobianRow,
             "its Jacobian has inf for residual 1 of 3 and number 5 of 27 of the state, expected "
             "finite numbers"},
        Case{"objective", "other_residuals", kJacobianRow,
             "with a Jacobian, residual 1 is another one"},
        Case{"objective", "has_no_jacobian", "it has what its capabilities claim",
             "they claim a jacobian, and has_jacobian() is false"}),
    [](const auto& each) { return each.param.fault; });

TEST(ContractProgram, AJacobianWithAKinkPasses) {
  const Outcome outcome = run_prior("none");
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr(kJacobianRow + ": ok\n"));
}

INSTANTIATE_TEST_SUITE_P(
    Model, Contract,
    ::testing::Values(
        Case{"model", "millimetres", "it is in metres", "is its file in another unit?"},
        Case{"model", "two_of_one_name", "an object can be made",
             "two landmarks are called 'base'"},
        Case{"model", "no_landmarks", "it has landmarks", "expected at least one"},
        Case{"model", "dead_angle", "every joint moves something",
             "the joint 'opening' moves nothing"},
        Case{"model", "never_the_same", "a second object is the same", "its mesh"},
        Case{"model", "ignores_position", "its position moves it rigidly", "metres from where",
             kItself},
        Case{"model", "ignores_rotation", "its rotation turns it rigidly about its origin",
             "metres from where", kItself},
        Case{"model", "moves_on_its_own", "it poses itself the same from several threads",
             "four threads posing at once differ from one", kItself},
        Case{"model", "dead_shape", "its shape parameters build it",
             "the shape parameter 'size' changes nothing"},
        Case{"model", "impossible_correlations", "its shape parameters build it",
             "'size' has 1 correlations, expected 0"},
        Case{"model", "skewed_directions", "its directions are perpendicular unit vectors",
             "its direction 'front' is 0.8 0 0.6, expected unit vectors of different names"},
        Case{"model", "two_directions_of_one_name", "its directions are perpendicular unit vectors",
             "its direction 'lid' is 1 0 0, expected unit vectors of different names"},
        Case{"model", "drops_triangles", "its shape parameters build it",
             "another shape has other triangles"}),
    [](const auto& each) { return each.param.fault; });

INSTANTIATE_TEST_SUITE_P(
    Source, Contract,
    ::testing::Values(
        Case{"source", "bad_camera", "its cameras are valid", "camera 0", kFrames},
        Case{"source", "no_frame_rate", "its frame rate is positive", "it is 0.0", kFrames},
        Case{"source", "no_cameras", "its cameras are valid", "it has no cameras", kFrames},
        Case{"source", "endless_frame_rate", "its frame rate is positive", "it is inf", kFrames},
        Case{"source", "one_view_too_few", kFramesRow, "frame 0 has 1 views; expected 2", kFrames},
        Case{"source", "wrong_size", kFramesRow,
             "frame 0, view 0: the image is 41x30 pixels, its camera 40x30", kFrames},
        Case{"source", "silent_gap", "every frame has pictures, or a problem",
             "frame 2: the source gives no views and no reason", kFrames},
        Case{"source", "time_stands_still", "times of frames grow",
             "frame 1 is not later than the one before it", kFrames},
        Case{"source", "truth_of_another_scene", "ground truth fits the scene",
             "the true state has 5 numbers, expected 27", kFrames},
        Case{"source", "landmarks_of_another_scene", "ground truth fits the scene",
             "2 true landmarks", kFrames},
        Case{"source", "draws_over_old_frames", "pictures belong to their frame",
             "frame 0, view 0: the pictures differ", kFrames},
        Case{"source", "never_the_same", "a second object yields the same frames",
             "the pictures differ", kFrames},
        Case{"source", "ends_late", "it ends where it says", "it promises 6 frames and gives more",
             kFrames},
        Case{"source", "gives_nothing", kFramesRow, "there is none", kFrames}),
    [](const auto& each) { return each.param.fault; });

INSTANTIATE_TEST_SUITE_P(
    Starter, Contract,
    ::testing::Values(
        Case{"starter", "gives_nothing", "it gives a state for a frame",
             "it gives nothing and throws nothing"},
        Case{"starter", "too_short", "its state fits the scene", "has 26 numbers, expected 27"},
        Case{"starter", "not_a_number", "its state fits the scene", "expected a finite number"},
        Case{"starter", "beyond_the_bounds", "its state fits the scene", "is 10 rad, expected"},
        Case{"starter", "long_quaternion", "its state fits the scene", "has the length 2.0"},
        Case{"starter", "throws_a_stranger",
             "it gives a state or an error of hypotrack for a frame without ground truth", "truth"},
        Case{"starter", "changes_with_the_frame", "without a frame it gives that state or nothing",
             "it gives another one"},
        Case{"starter", "remembers", "asked twice it gives the same", "it gives another one"},
        Case{"starter", "never_the_same", "a second object gives the same",
             "it gives another one"}),
    [](const auto& each) { return each.param.fault; });

const std::string kAnswersRow = "it answers any measures with a number or an infinity";
const std::string kThresholdsRow =
    "its thresholds are probabilities, and lost models are not tracked";

INSTANTIATE_TEST_SUITE_P(
    Judge, Contract,
    ::testing::Values(
        Case{"judge", "answers_nan", kAnswersRow, "the log odds of a pose are NaN"},
        Case{"judge", "throws_a_stranger", kAnswersRow, "agreement"},
        Case{"judge", "remembers", "asked twice it answers the same", "it gives other answers"},
        Case{"judge", "never_the_same", "a second object answers the same",
             "it gives other answers"},
        Case{"judge", "depends_on_the_thread", "several threads get the same answers",
             "four threads differ from one"},
        Case{"judge", "tracks_lost_models", kThresholdsRow,
             "first_above is 0.075000, below uncertain_above, 0.150000"},
        Case{"judge", "is_more_than_sure", kThresholdsRow,
             "certain_above is 1.500000, expected 0 to 1"},
        Case{"judge", "prefers_wrong_poses", "a right pose is likelier than one beside it",
             "the log odds of a box at its pose are -4.8"}),
    [](const auto& each) { return each.param.fault; });

const std::string kColumnsRow = "its columns of track.csv have names, and one value each";
const std::string kFileRow = "it writes the files that it asks for, and they are among its names";

INSTANTIATE_TEST_SUITE_P(
    Output, Contract,
    ::testing::Values(
        Case{"output", "writes_into_a_folder", "the names of its files are names",
             "'tables/numbers.txt' is not the name of a file"},
        Case{"output", "writes_what_it_does_not_name", kFileRow,
             "it writes 'mine.txt', which is none of its file_names()"},
        Case{"output", "forgets_a_file", kFileRow,
             "it asked for 'last_5.txt' and did not write it"},
        Case{"output", "does_not_ask", kFileRow, "it wrote 'extra.txt' without asking for it"},
        Case{"output", "names_a_column_badly", kColumnsRow,
             "wants to add the column 'last frame' to track.csv"},
        Case{"output", "writes_too_many_values", kColumnsRow,
             "more values are written than it has columns, which are 1"},
        Case{"output", "needs_pictures", "it takes smoothed solutions without pictures", "views"},
        Case{"output", "needs_all_frames", "it completes the files of a run that ends early",
             "there are more frames"},
        Case{"output", "never_the_same", "a second object writes the same",
             "'numbers.txt' has another content"}),
    [](const auto& each) { return each.param.fault; });

class ContractKept : public ::testing::TestWithParam<Case> {};

TEST_P(ContractKept, WithoutAFaultEveryRowPasses) {
  const Outcome outcome = run(GetParam().kind, "fault: none\n" + GetParam().more);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("an object can be made: ok\n"),
                                    HasSubstr(" passed, 0 failed, "), Not(HasSubstr("FAILED"))));
}

INSTANTIATE_TEST_SUITE_P(All, ContractKept,
                         ::testing::Values(Case{"optimizer"}, Case{"objective"}, Case{"model"},
                                           Case{"model", "", "", "", kItself},
                                           Case{"source", "", "", "", kFrames}, Case{"starter"},
                                           Case{"judge"}, Case{"output"}));

Outcome run_on_device(const std::string& fault) {
  const test::TemporaryDirectory folder;
  const auto file = folder.path() / "parameters.yaml";
  std::ofstream(file) << "fault: " + fault + "\n";
  const std::string library =
      std::string(HYPOTRACK_BROKEN_PLUGINS) + "/libhypotrack_objective_broken_device.so";
  return run({"objective", library, file.string()});
}

class DeviceContract : public ::testing::TestWithParam<Case> {};

TEST_P(DeviceContract, OneFaultFailsItsRow) {
  SKIP_WITHOUT_DEVICE();
  const Outcome outcome = run_on_device(GetParam().fault);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output, HasSubstr(GetParam().row + ": FAILED\n"));
  EXPECT_THAT(outcome.output, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Objective, DeviceContract,
    ::testing::Values(Case{"objective", "another_cost", "costs on the device are those on the CPU",
                           "a rectified pair: state 0 costs"},
                      Case{"objective", "never_repeats", "costs on the device repeat to the bit",
                           "a rectified pair: scoring twice gives two costs"},
                      Case{"objective", "accepts_everything",
                           "the device refuses what the CPU refuses",
                           "a single view: accepted on the device, but not on the CPU"}),
    [](const auto& each) { return each.param.fault; });

TEST(ContractProgram, RowsForTheDevicePassOrSayWhatIsMissing) {
  const std::string why = cuda::why_no_device();
  const Outcome outcome = run_on_device("none");
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_THAT(outcome.output, Not(HasSubstr("FAILED")));
  for (const std::string row :
       {"the device refuses what the CPU refuses", "costs on the device are those on the CPU",
        "costs on the device repeat to the bit"}) {
    EXPECT_THAT(outcome.output, HasSubstr(row + (why.empty() ? ": ok\n" : ": skipped\n    ")));
  }
}

TEST(ContractProgram, NamesAreKnownOrFreeAndParametersHaveHelp) {
  const Outcome outcome = run({"objective", std::string(HYPOTRACK_BROKEN_PLUGINS) +
                                                "/libhypotrack_objective_broken_names.so"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output,
              AllOf(HasSubstr("no capability is misspelt: FAILED\n"
                              "    nobody knows the capability 'devices'; did you mean 'device'?"),
                    Not(HasSubstr("of_its_own")),
                    HasSubstr("no parameter has a name that scenes take: FAILED\n"
                              "    scenes read 'weight' of every objective themselves"),
                    HasSubstr("every parameter has a line of help: FAILED\n"
                              "    the parameter 'sigma' has none: write {.help = ")));
}

TEST(ContractProgram, ACostThatIsNanFailsOneRow) {
  const Outcome outcome = run("objective", "fault: nan_where_nothing_is_covered\n");
  EXPECT_THAT(outcome.output, HasSubstr(" passed, 1 failed, "));
}

TEST(ContractProgram, ACrashOfAnObjectiveSaysWithWhichObservation) {
  const Outcome outcome = run("objective", "fault: crashes\n");
  EXPECT_NE(outcome.status, 0);
  EXPECT_THAT(outcome.output, HasSubstr("hypotrack: objective " + library("objective") +
                                        ": crashed in the row above, with a rectified pair\n"));
}

TEST(ContractProgram, ACrashSaysInWhichPluginAndRow) {
  const Outcome outcome = run("optimizer", "fault: crashes\n");
  EXPECT_NE(outcome.status, 0);
  EXPECT_THAT(outcome.output, HasSubstr("it searches in 1 to 54 dimensions"));
  EXPECT_THAT(outcome.output, HasSubstr("hypotrack: optimizer " + library("optimizer") +
                                        ": crashed in the row above\n"));
}

TEST(ContractProgram, AnotherKindIsNoticed) {
  const Outcome outcome = run({"model", library("optimizer")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output, HasSubstr("it is a plugin of kind 'optimizer', expected 'model'"));
}

TEST(ContractProgram, AFileThatASceneCouldNotFindIsNoticed) {
  const test::TemporaryDirectory folder;
  const auto file = folder.path() / "mine.so";
  std::filesystem::copy(library("optimizer"), file);
  const Outcome outcome = run({"optimizer", file.string()});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output, HasSubstr("the file is mine.so, expected "
                                        "libhypotrack_optimizer_broken.so"));
}

TEST(ContractProgram, AFileThatIsNoLibraryIsNoticed) {
  const test::TemporaryDirectory folder;
  const auto file = folder.path() / "libhypotrack_model_text.so";
  std::ofstream(file) << "not a library";
  const Outcome outcome = run({"model", file.string()});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output, HasSubstr("library opens and describes itself: FAILED\n"
                                        "    cannot be opened"));
}

TEST(ContractProgram, ParametersThatDoNotFitFailTheirRow) {
  const Outcome outcome = run("optimizer", "fault: gigantic\n");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("an object can be made: FAILED"),
                                    HasSubstr("parameters.yaml:1:"), HasSubstr("gigantic")));
}

TEST(ContractProgram, ASourceWithoutParametersIsSkippedSayingSo) {
  const Outcome outcome = run({"source", library("source")});
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_THAT(outcome.output,
              AllOf(HasSubstr("an object can be made: skipped\n"), HasSubstr("it needs parameters"),
                    HasSubstr("frames"), HasSubstr("CONTRACT_CONFIG")));
}

TEST(ContractProgram, AWrongCommandLineSaysHow) {
  const Outcome outcome = run({"camera", library("source")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.output, HasSubstr("usage: hypotrack_contract_test KIND FILE.so"));
}

}  // namespace
}  // namespace hypotrack
