#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "program.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {

/// A test with a folder of its own, a scene in it and a place for results.
class AppTest : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  const std::filesystem::path& folder() const { return folder_.path(); }

  /// Writes a scene and returns its path.
  std::string scene(const std::string& text, const std::string& name = "scene.yaml") const {
    write_text(path(name), text);
    return path(name).string();
  }

  /// Runs a scene into folder/out.
  Outcome run(const std::string& text, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"run", scene(text), "--out", path("out").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }

  /// Runs a scene, which must fail with one message that has `pieces` in it and leave no result.
  void expect_refused(const std::string& text, const std::vector<std::string>& pieces,
                      const std::vector<std::string>& more = {}) const {
    expect_refusal(run(text, more), pieces);
  }

  void expect_refusal(const Outcome& outcome, const std::vector<std::string>& pieces) const {
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    for (const std::string& piece : pieces) EXPECT_THAT(outcome.err, testing::HasSubstr(piece));
    const auto lines = lines_of(outcome.err);
    const auto messages = std::count_if(lines.begin(), lines.end(), [](const std::string& line) {
      return line.starts_with("hypotrack: ");
    });
    EXPECT_EQ(messages, 1) << outcome.err;
    EXPECT_THAT(outcome.err, testing::Not(testing::HasSubstr("unexpected error")));
    EXPECT_EQ(outcome.out, "");
    EXPECT_FALSE(std::filesystem::exists(path("out")));
  }

 private:
  TemporaryDirectory folder_;
};

}  // namespace hypotrack::test
