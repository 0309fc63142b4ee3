#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/subprocess.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {

/// How the program is started.
struct Start {
  std::vector<std::string> arguments;
  std::filesystem::path directory;       ///< working directory; the test's own if empty
  std::vector<std::string> environment;  ///< `NAME=value`, on top of the test's own
  std::filesystem::path out;             ///< takes what it prints; if empty, Outcome::out does
  std::filesystem::path err;             ///< the same of the standard error
  long largest_file = 0;  ///< bytes; 0: no limit. Writing on fails, as on a full disk
};

/// What the program did.
struct Outcome {
  int exit_code = -1;  ///< 128 + signal if a signal ended it
  std::string out, err;
};

/// The program `hypotrack` in a process of its own.
class Program {
 public:
  explicit Program(const Start& start);

  void signal(int number) const;
  bool running();
  /// Waits for the end.
  Outcome wait();

 private:
  TemporaryDirectory folder_;          ///< holds what the program says
  std::optional<Subprocess> process_;  ///< ends before the folder
};

Outcome run_program(const Start& start);
Outcome run_program(const std::vector<std::string>& arguments);

std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, const std::string& text);
std::vector<std::string> lines_of(const std::string& text);
/// Names in a folder, sorted; empty if there is no such folder.
std::vector<std::string> names_in(const std::filesystem::path& folder);
/// track.csv without the milliseconds, the one column that no two runs share.
std::string track_without_times(const std::filesystem::path& folder);

/// A scene of a box in small synthetic pictures: five frames, a few milliseconds each.
std::string box_scene();
/// The same text with one piece replaced; the piece must be there.
std::string replaced(std::string text, const std::string& piece, const std::string& by);

}  // namespace hypotrack::test
