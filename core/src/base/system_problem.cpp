#include "base/system_problem.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <filesystem>
#include <string_view>

namespace hypotrack::internal {
namespace {

/// Returns the text that the thrower gave, without the message of the number.
std::string own_text(const std::system_error& error) {
  const std::string_view all = error.what();
  const std::string message = error.code().message();
  if (all == message) return {};
  const std::string tail = ": " + message;
  return std::string(all.ends_with(tail) ? all.substr(0, all.size() - tail.size()) : all);
}

std::string place_of(const std::filesystem::filesystem_error& error) {
  if (error.path2().empty()) return error.path1().string();
  return fmt::format("{} -> {}", error.path1().string(), error.path2().string());
}

/// Returns what the library wanted to do, without its preface and the paths.
std::string wish_of(const std::filesystem::filesystem_error& error) {
  std::string_view text = error.what();
  constexpr std::string_view kPreface = "filesystem error: ";
  if (text.starts_with(kPreface)) text.remove_prefix(kPreface.size());
  return std::string(text.substr(0, text.find(": ")));
}

}  // namespace

std::string advice_on(int error) {
  switch (error) {
    case EMFILE:
      return "this program may not open more files: raise its limit (`ulimit -n 4096`)";
    case ENFILE:
      return "the computer may not open more files: end other programs, or raise fs.file-max";
    case EAGAIN:
      return "no further thread or process may start: end other programs, or raise the limit of "
             "the user (`ulimit -u`) or of the container (--pids-limit)";
    case ENOMEM:
      return "memory is short: end other programs, or raise the limit (`ulimit -v`)";
    case ENOSPC:
    case EDQUOT:
      return "make room, or name a folder on another disk";
    case EFBIG:
      return "raise the limit on the size of files (`ulimit -f`)";
    case EROFS:
      return "name a folder that can be written";
    case EACCES:
    case EPERM:
      return "check its permissions and those of its folder";
    case ENOENT:
    case ENOTDIR:
      return "check that its folder exists";
    default:
      return {};
  }
}

bool is_shortage(int error) {
  return error == EMFILE || error == ENFILE || error == EAGAIN || error == ENOMEM;
}

std::string with_advice(std::string message) {
  for (const int error : {EMFILE, ENFILE, EAGAIN, ENOMEM}) {
    const std::string advice = advice_on(error);
    const bool named = message.find(std::generic_category().message(error)) != std::string::npos;
    if (named && message.find(advice) == std::string::npos) return message + "; " + advice;
  }
  return message;
}

std::string described(int error) {
  const std::string advice = advice_on(error);
  return std::generic_category().message(error) + (advice.empty() ? "" : "; " + advice);
}

std::string described(const std::system_error& error) {
  const int number = error.code().value();
  const bool known = error.code().category() == std::generic_category() ||
                     error.code().category() == std::system_category();
  const std::string why = known ? described(number) : error.code().message();
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error);
      file && !file->path1().empty())
    return fmt::format("{}: {}: {}", place_of(*file), wish_of(*file), why);
  std::string wish = own_text(error);
  // std::thread says no more than this.
  if (wish.empty() && known && number == EAGAIN) wish = "a thread cannot be started";
  return wish.empty() ? why : fmt::format("{}: {}", wish, why);
}

}  // namespace hypotrack::internal
