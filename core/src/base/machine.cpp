#include "base/machine.hpp"

#include <sched.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "base/descriptor.hpp"

namespace hypotrack::internal {
namespace {

/// Binds a socket in Linux's abstract namespace, which leaves no file and ends with the process.
/// Returns nothing if another process has it. Throws std::system_error.
std::optional<Descriptor> bind(const std::string& name) {
  Descriptor made(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  const std::string text = '\0' + std::string("hypotrack/") + name;
  const std::size_t size = std::min(text.size(), sizeof address.sun_path);
  std::copy_n(text.begin(), size, address.sun_path);
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + size);
  if (::bind(made.get(), reinterpret_cast<const sockaddr*>(&address), length) == 0) return made;
  if (errno == EADDRINUSE) return std::nullopt;
  throw_system_error(errno, "cannot bind a socket");
}

/// Returns the limit of this process's control group (cgroup v2); the largest number without one.
std::size_t group_limit() {
  std::size_t limit = std::numeric_limits<std::size_t>::max();
  std::ifstream groups("/proc/self/cgroup");
  std::string line;
  while (std::getline(groups, line) && !line.starts_with("0::")) continue;
  if (!line.starts_with("0::")) return limit;
  std::filesystem::path group = "/sys/fs/cgroup";
  group += line.substr(3);
  // A group has what each group above it has.
  for (; group != group.root_path(); group = group.parent_path()) {
    std::ifstream in(group / "memory.max");
    std::size_t own = 0;
    if (in >> own) limit = std::min(limit, own);
  }
  return limit;
}

}  // namespace

int core_count() {
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof(cores), &cores) == 0) return std::max(1, CPU_COUNT(&cores));
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

std::size_t memory_size() {
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  const auto installed = static_cast<std::size_t>(std::max(0L, pages) * std::max(0L, page));
  return std::min(installed, group_limit());
}

std::string processor_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

bool claim(const std::string& name) {
  static std::mutex mutex;
  static std::map<std::string, Descriptor> claims;
  const std::lock_guard lock(mutex);
  if (claims.contains(name)) return true;
  try {
    std::optional<Descriptor> made = bind(name);
    if (!made) return false;
    claims.emplace(name, std::move(*made));
  } catch (const std::system_error&) {  // no sockets here
  }
  return true;
}

}  // namespace hypotrack::internal
