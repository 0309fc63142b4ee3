#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;

/// A test on a machine whose NVIDIA driver is too old for this build.
class OldDriverTest : public AppTest {
 protected:
  Outcome run_with_old_driver(const std::string& backend) const {
    Start start;
    start.arguments = {"run", scene(box_scene() + "evaluate: {backend: " + backend + "}\n"),
                       "--out", path("out").string()};
    start.environment = {"LD_LIBRARY_PATH=" +
                         (build_dir() / "tests/plugin_fixtures/old_driver").string()};
    return run_program(start);
  }
  const std::string kReason =
      "the NVIDIA driver is too old: it supports CUDA 11.4, hypotrack was built with ";
};

TEST_F(OldDriverTest, ARunSaysBothVersionsAndWhatToWrite) {
  expect_refusal(run_with_old_driver("cuda"),
                 {"evaluate.backend: cuda: " + kReason, "Write `backend: cpu`"});
}

TEST_F(OldDriverTest, AutomaticTakesTheCpuAndSaysWhy) {
  const Outcome outcome = run_with_old_driver("auto");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("not on a GPU: " + kReason));
}

TEST_F(OldDriverTest, DoctorSaysThatTheDriverIsBroken) {
  Start start;
  start.arguments = {"doctor"};
  start.environment = {"LD_LIBRARY_PATH=" +
                       (build_dir() / "tests/plugin_fixtures/old_driver").string()};
  EXPECT_THAT(run_program(start).out, testing::ContainsRegex("broken +CUDA +" + kReason));
}

}  // namespace
}  // namespace hypotrack::test
