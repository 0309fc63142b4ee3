#include "run/crew/gpu_worker.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <array>
#include <utility>

#include "run/crew/process_pool.hpp"

namespace hypotrack::internal {
namespace {

/// Starts a worker that talks through the other end of a socket.
Subprocess start_worker(const CrewSettings& settings, int gpu, const std::filesystem::path& log,
                        int socket) {
  Subprocess::Command command{.program = settings.program};
  for (const auto& folder : settings.plugin_path)
    command.arguments.insert(command.arguments.end(), {"--plugin-path", folder.string()});
  command.arguments.insert(command.arguments.end(), {"work", "--gpu", fmt::format("{}", gpu)});
  command.directory = settings.directory;
  command.variables = settings.variables;
  command.output = command.errors = log;
  command.descriptors = {{socket, kWorkerSocket}};
  return start_process(command);
}

std::pair<Descriptor, Descriptor> socket_pair() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw_system_error(errno, "cannot make a socket");
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

}  // namespace

GpuWorker::GpuWorker(const CrewSettings& settings, int gpu, const std::filesystem::path& log)
    : GpuWorker(settings, gpu, log, socket_pair()) {}

GpuWorker::GpuWorker(const CrewSettings& settings, int gpu, const std::filesystem::path& log,
                     std::pair<Descriptor, Descriptor> ends)
    : time_limit_s_(settings.time_limit_s),
      socket_(std::move(ends.first)),
      process_(start_worker(settings, gpu, log, ends.second.get())) {}

void GpuWorker::give(const Job& job) {
  const std::string line = line_of(job, time_limit_s_) + "\n";
  std::size_t sent = 0;
  while (sent < line.size()) {
    const ssize_t size = send(socket_.get(), line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return;  // it has ended, which running() says
    sent += static_cast<std::size_t>(size);
  }
}

std::vector<WorkerAnswer> GpuWorker::take_answers() {
  std::array<char, 4096> chunk;
  for (;;) {
    const ssize_t size = recv(socket_.get(), chunk.data(), chunk.size(), MSG_DONTWAIT);
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) break;
    lines_.add(chunk.data(), static_cast<std::size_t>(size));
  }
  std::vector<WorkerAnswer> answers;
  while (const auto line = lines_.next()) answers.push_back(parse_answer(*line));
  return answers;
}

void GpuWorker::close() { shutdown(socket_.get(), SHUT_WR); }

}  // namespace hypotrack::internal
