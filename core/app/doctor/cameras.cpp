#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "doctor/check.hpp"

namespace hypotrack::doctor {
namespace {

struct Device {
  int number = 0;
  std::filesystem::path file;
};

/// Returns the number in a file name such as video12.
std::optional<int> number_of(const std::string& name) {
  constexpr std::string_view kPrefix = "video";
  if (!name.starts_with(kPrefix)) return std::nullopt;
  int number = 0;
  const char* const end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data() + kPrefix.size(), end, number);
  return error == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

std::vector<Device> video_devices(const std::filesystem::path& folder) {
  std::vector<Device> out;
  std::error_code unreadable;
  for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable))
    if (const auto number = number_of(entry.path().filename().string()))
      out.push_back({*number, entry.path()});
  std::ranges::sort(out, {}, &Device::number);
  return out;
}

std::string first_line(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

}  // namespace

Check check_cameras(const std::filesystem::path& devices, const std::filesystem::path& classes) {
  Check check{.name = "cameras"};
  std::vector<std::string> found, closed;
  for (const Device& device : video_devices(devices)) {
    const std::filesystem::path folder = classes / device.file.filename();
    const std::string index = first_line(folder / "index");
    if (!index.empty() && index != "0") continue;  // metadata of a camera that is listed
    const std::string name = first_line(folder / "name");
    found.push_back(
        fmt::format("{} {}", device.file.string(), name.empty() ? "without a name" : name));
    if (access(device.file.c_str(), R_OK | W_OK) != 0) closed.push_back(device.file.string());
  }
  check.found = fmt::format("{}", fmt::join(found, "\n"));
  if (found.empty()) {
    check.state = State::missing;
    check.found = fmt::format("no {}/video*", devices.string());
    check.fix = "connect cameras; recordings are tracked without";
  } else if (!closed.empty()) {
    check.state = State::broken;
    check.found += fmt::format("\nno permission to open {}", fmt::join(closed, ", "));
    check.fix = "sudo usermod -aG video \"$USER\", then log in again";
  }
  return check;
}

}  // namespace hypotrack::doctor
