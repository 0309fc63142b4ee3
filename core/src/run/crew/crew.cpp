#include "run/crew/crew.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "base/numbers.hpp"
#include "cost/cuda/device.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::string_view kAdvice = "; leave --gpus out";  // where there is no GPU

std::vector<int> parse_numbers(const std::string& text) {
  std::vector<int> numbers;
  std::string_view rest = text;
  for (bool more = true; more;) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    const auto number = detail::parse_integer(std::string(rest.substr(0, end)));
    const bool known = number && std::ranges::find(numbers, *number) != numbers.end();
    if (!number || *number < 0 || *number > 1024 || known)
      throw ConfigError(fmt::format(
          "--gpus {}: expected all, auto, or different numbers of GPUs with commas, as 0,2", text));
    numbers.push_back(static_cast<int>(*number));
    more = end < rest.size();
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return numbers;
}

/// Returns the command of a process for one job.
Subprocess::Command command_of(const CrewSettings& settings, const Job& job) {
  Subprocess::Command command{.program = settings.program};
  auto& words = command.arguments;
  for (const auto& folder : settings.plugin_path)
    words.insert(words.end(), {"--plugin-path", folder.string()});
  words.insert(words.end(), {job.check ? "validate" : "run", job.scene.string()});
  if (!job.check) words.insert(words.end(), {"--out", job.out.string()});
  for (const std::string& assignment : job.set) words.insert(words.end(), {"--set", assignment});
  if (job.frames) words.insert(words.end(), {"--frames", fmt::format("{}", *job.frames)});
  command.directory = settings.directory;
  command.variables = settings.variables;
  command.output = command.errors = job.log;
  command.descriptors = job.descriptors;
  return command;
}

}  // namespace

GpuList parse_gpus(const std::string& text) {
  GpuList list{{}, text != "auto"};
  if (text == "all" || text == "auto") {
    while (cuda::why_no_device(static_cast<int>(list.numbers.size())).empty())
      list.numbers.push_back(static_cast<int>(list.numbers.size()));
    if (list.numbers.empty())
      throw DeviceError(fmt::format("--gpus {}: {}{}", text, cuda::why_no_device(), kAdvice));
    return list;
  }
  list.numbers = parse_numbers(text);
  for (const int number : list.numbers)
    if (const std::string why = cuda::why_no_device(number); !why.empty())
      throw DeviceError(
          fmt::format("--gpus {}: {}{}", text, why, cuda::why_no_device().empty() ? "" : kAdvice));
  return list;
}

std::vector<std::string> driver_variables(int threads) {
  constexpr const char* kMesaThreads = "LP_NUM_THREADS";
  if (std::getenv(kMesaThreads)) return {};
  return {fmt::format("{}={}", kMesaThreads, threads)};
}

Crew::Crew(CrewSettings settings)
    : settings_(std::move(settings)),
      pool_(settings_.time_limit_s),
      workers_(settings_, scratch_.path()) {}

std::string Crew::start_gpus(bool all_needed) {
  std::vector<std::string> named, absent;
  std::vector<int> there;
  for (const GpuState& gpu : workers_.start()) {
    if (!gpu.why.empty()) {
      absent.push_back(fmt::format("GPU {}: {}", gpu.number, gpu.why));
      continue;
    }
    there.push_back(gpu.number);
    named.push_back(fmt::format("GPU {} ({})", gpu.number, gpu.name));
  }
  if (there.empty() || (all_needed && !absent.empty()))
    throw DeviceError(
        fmt::format("--gpus: {}{}", fmt::join(absent, "; "),
                    there.empty() ? "; leave --gpus out" : "; `--gpus auto` leaves it out"));
  settings_.gpus = there;
  std::string text = fmt::format("{}", fmt::join(named, ", "));
  if (!absent.empty()) text += fmt::format("; without {}", fmt::join(absent, "; "));
  return text;
}

void Crew::start(Job job) {
  if (job.gpu) return workers_.add(std::move(job));
  pool_.start(job.key, command_of(settings_, job));
}

std::optional<Ended> Crew::take_ended() {
  if (const auto ended = pool_.take_ended()) return ended;
  return workers_.take_ended();
}

void Crew::interrupt() {
  pool_.signal(SIGINT);
  workers_.interrupt();
}

void Crew::kill() {
  pool_ = ProcessPool(settings_.time_limit_s);
  workers_.kill();
}

}  // namespace hypotrack::internal
