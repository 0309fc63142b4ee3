#include "running/web_token.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/descriptor.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::app {
namespace {

constexpr const char* kVariable = "HYPOTRACK_WEB_TOKEN";
constexpr const char* kExample = "the output of `openssl rand -hex 16`";

[[noreturn]] void refuse_file(const std::filesystem::path& file, int problem) {
  throw ConfigError(fmt::format(
      "--web-token-file {}: cannot be read: {}; name a file that holds the secret word, for "
      "example {}",
      file.string(), std::generic_category().message(problem), kExample));
}

/// Returns what a file or pipe holds.
std::string text_of(const std::filesystem::path& file, int opened) {
  constexpr std::size_t kMost = 4096;
  std::string text;
  std::array<char, 512> piece{};
  while (text.size() <= kMost) {
    const ssize_t size = ::read(opened, piece.data(), piece.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) refuse_file(file, errno);
    if (size == 0) return text;
    text.append(piece.data(), static_cast<std::size_t>(size));
  }
  throw ConfigError(fmt::format(
      "--web-token-file {}: has more than {} bytes; expected one line, the secret word, for "
      "example {}",
      file.string(), kMost, kExample));
}

/// Returns the word in a file, without the end of its line.
std::string read_word(const std::filesystem::path& file,
                      const std::function<void(const std::string&)>& note) {
  const int opened = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (opened < 0) refuse_file(file, errno);
  const Descriptor descriptor(opened);
  struct stat state {};
  if (fstat(descriptor.get(), &state) == 0 && S_ISREG(state.st_mode) &&
      (state.st_mode & S_IROTH) != 0)
    note(fmt::format(
        "note: --web-token-file {0}: every user of this computer may read the secret word; "
        "`chmod go= {0}` keeps it to you",
        file.string()));
  std::string text = text_of(file, descriptor.get());
  while (text.ends_with('\n') || text.ends_with('\r')) text.pop_back();
  return text;
}

}  // namespace

std::optional<std::string> take_web_token_variable() {
  const char* const value = std::getenv(kVariable);
  if (!value) return std::nullopt;
  std::string word = value;
  unsetenv(kVariable);
  return word;
}

WebToken read_web_token(const WebTokenSources& sources,
                        const std::function<void(const std::string&)>& note) {
  std::vector<std::string> given;
  if (sources.word) given.emplace_back("--web-token");
  if (sources.file) given.emplace_back("--web-token-file");
  if (sources.variable) given.emplace_back(kVariable);
  if (given.empty()) return {};
  if (given.size() > 1)
    throw ConfigError(fmt::format("{} give the secret word of the page; leave all but one out",
                                  fmt::join(given, " and ")));
  WebToken token{.word = {}, .source = given.front()};
  if (sources.file) {
    token.word = read_word(*sources.file, note);
    token.source += " " + sources.file->string();
  } else {
    token.word = sources.word ? *sources.word : *sources.variable;
  }
  if (token.word.empty())
    throw ConfigError(fmt::format("{}: is empty; expected a secret word, for example {}",
                                  token.source, kExample));
  return token;
}

}  // namespace hypotrack::app
