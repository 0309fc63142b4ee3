#include "run/crew/scratch_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "hypotrack_";
constexpr std::string_view kSuffix = "_XXXXXX";  // mkdtemp() chooses the letters

/// Returns the process that made a folder of this name; 0: it is no scratch folder.
pid_t maker_of(std::string_view name) {
  if (!name.starts_with(kPrefix) || name.size() <= kPrefix.size() + kSuffix.size()) return 0;
  const char* const end = name.data() + name.size() - kSuffix.size();
  pid_t pid = 0;
  const auto parsed = std::from_chars(name.data() + kPrefix.size(), end, pid);
  return parsed.ec == std::errc() && parsed.ptr == end && *end == '_' && pid > 0 ? pid : 0;
}

/// Opens a folder and locks it; nothing if it cannot, as if another process holds it.
std::optional<Descriptor> lock_folder(const fs::path& folder) {
  const int opened = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (opened < 0) return std::nullopt;
  Descriptor descriptor(opened);
  if (flock(descriptor.get(), LOCK_EX | LOCK_NB) != 0) return std::nullopt;
  return descriptor;
}

/// Removes this user's scratch folders of processes that have ended.
void remove_left_folders(const fs::path& parent) {
  std::error_code error;
  for (fs::directory_iterator it(parent, error), end; !error && it != end; it.increment(error)) {
    const fs::path folder = it->path();
    const pid_t maker = maker_of(folder.filename().string());
    if (maker == 0 || ::kill(maker, 0) == 0 || errno != ESRCH) continue;
    struct stat info {};
    if (lstat(folder.c_str(), &info) != 0 || info.st_uid != geteuid()) continue;
    std::error_code ignored;
    if (const auto lock = lock_folder(folder)) fs::remove_all(folder, ignored);
  }
}

[[noreturn]] void fail(const std::error_code& error) {
  std::string place = "/tmp";
  for (const char* name : {"TEMPDIR", "TEMP", "TMP", "TMPDIR"})  // the last one counts
    if (const char* value = getenv(name)) place = fmt::format("{}={}", name, value);
  throw OutputError(
      fmt::format("{}: cannot make a temporary folder there: {}; set TMPDIR to a folder with room",
                  place, error.message()));
}

}  // namespace

ScratchFolder::ScratchFolder() {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error);
  if (error) fail(error);
  remove_left_folders(parent);
  std::string name = (parent / fmt::format("{}{}{}", kPrefix, getpid(), kSuffix)).string();
  if (!mkdtemp(name.data())) fail({errno, std::generic_category()});
  path_ = name;
  if (auto lock = lock_folder(path_)) lock_.emplace(std::move(*lock));
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace hypotrack::internal
