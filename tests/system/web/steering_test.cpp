#include <fmt/format.h>

#include <csignal>
#include <filesystem>

#include "hypotrack/api/media.hpp"
#include "served_run.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;

using SteeringTest = ServedRun;

TEST_F(SteeringTest, PauseStopsFramesAndStepAdvancesOne) {
  start();
  const int frame = pause();
  for (int i = 0; i < 50; ++i) EXPECT_EQ(state()["frame"], frame);
  EXPECT_EQ(post("/step"), 204);
  wait_for([&](const auto& now) { return now["frame"] != frame; });
  for (int i = 0; i < 50; ++i) EXPECT_EQ(state()["frame"], frame + 1);
  EXPECT_EQ(state()["run"], "paused");
  EXPECT_EQ(post("/resume"), 204);
  const auto later = wait_for([&](const auto& now) { return now["frame"] > frame + 3; });
  EXPECT_EQ(later["run"], "runs");
}

TEST_F(SteeringTest, CurlPausesARunAsTheGuideSays) {
  const std::string curl = "/usr/bin/curl";
  if (!std::filesystem::exists(curl)) GTEST_SKIP() << "needs curl";
  start();
  const std::string address = fmt::format("http://127.0.0.1:{}/pause", port());
  const Captured said = capture_output(
      {curl, {"-s", "--noproxy", "*", "-X", "POST", address, "-w", "%{http_code}"}}, {1});
  EXPECT_EQ(said.output, "204");
  wait_for([](const auto& now) { return now["run"] == "paused"; });
}

TEST_F(SteeringTest, CtrlCEndsAPausedRun) {
  start();
  const int frame = pause();
  program().signal(SIGINT);
  EXPECT_EQ(program().wait().exit_code, 130);
  EXPECT_EQ(lines_of(read_text(path("out/track.csv"))).size(), static_cast<std::size_t>(frame) + 2);
}

TEST_F(SteeringTest, SnapshotsAreWrittenWithTheResults) {
  start();
  const int frame = pause();
  EXPECT_EQ(post("/snapshot"), 204);
  wait_for([](const auto& now) { return now["text"] != ""; });
  program().signal(SIGINT);
  program().wait();
  const std::string name = path("out/" + fmt::format("snapshot_{:06}.png", frame)).string();
  EXPECT_EQ(read_image(name).size(), cv::Size(320, 120));
  EXPECT_THAT(read_text(path("out/" + fmt::format("snapshot_{:06}.yaml", frame))),
              HasSubstr("position_mm"));
}

TEST_F(SteeringTest, ARestartedRunFindsTheModelsAgain) {
  start();
  const int frame = pause();
  EXPECT_EQ(post("/restart"), 204);
  EXPECT_EQ(post("/resume"), 204);
  const auto later =
      wait_for([&](const auto& now) { return now["frame"] > frame && now["status"] == "tracked"; });
  EXPECT_LT(later["error_mm"], 30);
}

}  // namespace
}  // namespace hypotrack::test
