#include <fmt/format.h>
#include <string.h>

#include <algorithm>
#include <fstream>
#include <string_view>

#include "run/crew/crew.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::string_view kMessagePrefix = "hypotrack: ";
constexpr std::size_t kLongestLine = 200;  // bytes

struct Log {
  std::string message;    ///< last message of hypotrack
  std::string last_line;  ///< last line with a letter
};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

Log read_log(const std::filesystem::path& file) {
  Log log;
  std::ifstream in(file);
  bool goes_on = false;  // further lines of a message are indented
  for (std::string line; std::getline(in, line);) {
    const std::size_t text = line.find_first_not_of(' ');
    if (line.starts_with(kMessagePrefix)) {
      log.message = line.substr(kMessagePrefix.size());
      goes_on = true;
    } else if (goes_on && text > 0 && text != std::string::npos) {
      log.message += " " + line.substr(text);
    } else {
      goes_on = false;
    }
    if (std::ranges::any_of(line, is_letter)) log.last_line = line.substr(text, kLongestLine);
  }
  return log;
}

std::string end_of(const Subprocess::End& end) {
  if (end.signal != 0)
    return fmt::format("ended by signal {} ({})", end.signal, strsignal(end.signal));
  if (end.code == 0) return "ended with exit code 0 before its results were complete";
  return fmt::format("ended with exit code {}", end.code);
}

}  // namespace

std::string failure_message(const std::filesystem::path& log_file, const Ended& ended) {
  if (ended.limit_s > 0)
    return fmt::format("did not end within {:g} s (--time-limit); ended there", ended.limit_s);
  const Log log = read_log(log_file);
  const bool chose_its_end = ended.end.signal == 0 && ended.end.code != 0;
  if (chose_its_end && !log.message.empty()) return log.message;
  if (!log.message.empty()) return log.message + "; " + end_of(ended.end);
  if (log.last_line.empty()) return end_of(ended.end);
  return fmt::format("{}; its last line: {}", end_of(ended.end), log.last_line);
}

}  // namespace hypotrack::internal
