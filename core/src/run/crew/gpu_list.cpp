#include "run/crew/gpu_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "base/numbers.hpp"
#include "cost/cuda/device.hpp"
#include "hypotrack/error.hpp"

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

}  // namespace hypotrack::internal
