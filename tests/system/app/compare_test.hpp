#pragma once

#include <chrono>
#include <thread>

#include "app_test.hpp"

namespace hypotrack::test {

/// A test with a study of a box: two budgets, two seeds, some milliseconds each.
class CompareTest : public AppTest {
 protected:
  CompareTest() {
    scene(replaced(box_scene(), "{overlay: false}", "{overlay: false, worst_frames: 0}"),
          "box.yaml");
  }

  static std::string study() {
    return R"(title: Two budgets
scenes:
  box: {file: box.yaml}
grid:
  optimizer.particles: [4, 8]
seeds: 2
frames: 3
)";
  }

  /// A study that lasts until it is stopped: each of its runs does.
  static std::string long_study() {
    return replaced(
        replaced(study(), "{file: box.yaml}", "{file: box.yaml, set: {source.frames: 1000000}}"),
        "frames: 3\n", "");
  }

  Start start(const std::string& text, const std::string& out,
              const std::vector<std::string>& more = {}) const {
    write_text(path("study.yaml"), text);
    Start start;
    start.arguments = {"compare", path("study.yaml").string(), "--out", path(out).string()};
    start.arguments.insert(start.arguments.end(), more.begin(), more.end());
    return start;
  }

  Outcome compare(const std::string& text, const std::string& out = "out",
                  const std::vector<std::string>& more = {}) const {
    return run_program(start(text, out, more));
  }

  std::string table(const std::string& name, const std::string& out = "out") const {
    return read_text(path(out) / name);
  }

  std::vector<std::string> run_names(const std::string& out = "out") const {
    return names_in(path(out) / "runs");
  }

  /// Waits until runs are being made.
  void wait_for_work(Program& program, const std::string& out, std::size_t tracks) const {
    const auto tracking = [&] {
      std::size_t count = 0;
      for (const std::string& name : names_in(path(out) / ".working"))
        count += std::filesystem::exists(path(out) / ".working" / name / "track.csv");
      return count;
    };
    while (program.running() && tracking() < tracks)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_TRUE(program.running()) << program.wait().err;
  }
};

}  // namespace hypotrack::test
