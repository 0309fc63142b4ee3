#include <nlohmann/json.hpp>

#include "app_test.hpp"
#include "doctor/check.hpp"

namespace hypotrack::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// What `hypotrack doctor --json` says.
struct Report {
  int exit_code = -1;
  json all;

  /// Returns the check of a name; fails the test if there is none.
  json check(const std::string& name) const {
    for (const json& one : all.at("checks"))
      if (one.at("name") == name) return one;
    ADD_FAILURE() << "no check '" << name << "' in " << all.dump(2);
    return {{"state", ""}, {"found", ""}, {"fix", ""}, {"needed", false}};
  }
};

class DoctorTest : public AppTest {
 protected:
  static Report doctor(const std::vector<std::string>& environment = {},
                       const std::vector<std::string>& more = {}) {
    Start start;
    start.arguments = {"doctor", "--json"};
    start.arguments.insert(start.arguments.end(), more.begin(), more.end());
    start.environment = environment;
    const Outcome outcome = run_program(start);
    EXPECT_EQ(outcome.err, "");
    return {outcome.exit_code, json::parse(outcome.out)};
  }
};

TEST_F(DoctorTest, ExitCodeIsThatOfWhatRunsNeed) {
  const Report report = doctor();
  bool ready = true;
  for (const json& check : report.all.at("checks")) {
    const bool good = check.at("state") == "ok";
    ready = ready && (good || !check.at("needed"));
    EXPECT_NE(check.at("found"), "") << check;
    EXPECT_EQ(check.at("fix") == "", good) << check;
  }
  EXPECT_EQ(report.all.at("ready"), ready);
  EXPECT_EQ(report.exit_code, ready ? 0 : 1);
  for (const char* name : {"SIMD", "threads", "OpenGL", "CUDA", "video", "hand detector", "cameras",
                           "data", "plugin folder", "model plugins", "lab commands"})
    EXPECT_NE(report.check(name).at("state"), "") << name;
}

TEST_F(DoctorTest, TheTableHasALinePerCheckAndAFixPerProblem) {
  Start start;
  start.arguments = {"doctor"};
  start.environment = {"HYPOTRACK_HAND_DETECTOR=" + path("none").string()};
  const std::vector<std::string> lines = lines_of(run_program(start).out);
  const auto line = std::ranges::find_if(
      lines, [](const std::string& text) { return text.starts_with("missing  hand detector"); });
  ASSERT_LT(line - lines.begin(), std::ssize(lines) - 1);
  EXPECT_THAT(*line, HasSubstr(path("none").string()));
  EXPECT_THAT(*std::next(line), HasSubstr("fix: hypotrack get detector"));
  EXPECT_THAT(lines.front(), testing::StartsWith("STATE"));
}

TEST_F(DoctorTest, ACrashingDriverIsOneBrokenCheck) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "with the sanitizer the driver is loaded before the program begins";
#endif
  const Report report =
      doctor({"LD_LIBRARY_PATH=" + (build_dir() / "tests/plugin_fixtures/crashing_egl").string()});
  EXPECT_EQ(report.exit_code, 1);
  EXPECT_EQ(report.all.at("ready"), false);
  const json check = report.check("OpenGL");
  EXPECT_EQ(check.at("state"), "broken");
  EXPECT_EQ(check.at("found"), "crashed: SIGABRT");
  EXPECT_THAT(check.at("fix").get<std::string>(), HasSubstr("driver"));
  EXPECT_EQ(report.check("data").at("state"), "ok");
}

TEST_F(DoctorTest, RefusedPluginsFailOnlyIfRunsNeedThem) {
  const auto with = [&](const std::string& library) {
    const std::filesystem::path plugins = path("plugins_" + library);
    std::filesystem::create_directory(plugins);
    write_text(plugins / ("libhypotrack_" + library + ".so"), "no library");
    return doctor({}, {"--plugin-path", plugins.string()});
  };
  const Report own = with("optimizer_mine");
  EXPECT_EQ(own.exit_code, own.all.at("ready") ? 0 : 1);
  EXPECT_EQ(own.check("plugin optimizer/mine").at("state"), "broken");
  EXPECT_EQ(own.check("plugin optimizer/mine").at("needed"), false);
  const Report needed = with("optimizer_pso");
  EXPECT_EQ(needed.exit_code, 1);
  EXPECT_THAT(needed.check("plugin optimizer/pso").at("found").get<std::string>(),
              HasSubstr("libhypotrack_optimizer_pso.so"));
}

TEST_F(DoctorTest, ADamagedHandDetectorIsBroken) {
  std::filesystem::create_directory(path("detector"));
  write_text(path("detector/palm_detection_full.net"), "no network");
  const json check =
      doctor({"HYPOTRACK_HAND_DETECTOR=" + path("detector").string()}).check("hand detector");
  EXPECT_EQ(check.at("state"), "broken");
  EXPECT_THAT(check.at("found").get<std::string>(), HasSubstr("damaged"));
  EXPECT_EQ(check.at("fix"), "hypotrack get detector");
}

/// Folders like /dev and /sys/class/video4linux.
class DoctorCamerasTest : public AppTest {
 protected:
  void add(const std::string& device, const std::string& name, const std::string& index) const {
    std::filesystem::create_directories(path("sys") / device);
    std::filesystem::create_directories(path("dev"));
    write_text(path("dev") / device, "");
    if (!name.empty()) write_text(path("sys") / device / "name", name + "\n");
    write_text(path("sys") / device / "index", index + "\n");
  }
  doctor::Check check() const { return doctor::check_cameras(path("dev"), path("sys")); }
};

TEST_F(DoctorCamerasTest, CamerasAreListedByNumberWithTheirNames) {
  add("video10", "Right camera", "0");
  add("video2", "Left camera", "0");
  add("video3", "Left camera", "1");  // its metadata
  add("video4", "", "0");
  EXPECT_EQ(check().state, doctor::State::ok);
  const std::string dev = path("dev").string();
  EXPECT_EQ(check().found, dev + "/video2 Left camera\n" + dev + "/video4 without a name\n" + dev +
                               "/video10 Right camera");
}

TEST_F(DoctorCamerasTest, NoCameraIsMissing) {
  EXPECT_EQ(check().state, doctor::State::missing);
  EXPECT_FALSE(check().needed);
  add("videodev", "none", "0");
  EXPECT_EQ(check().state, doctor::State::missing);
}

}  // namespace
}  // namespace hypotrack::test
