#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/machine.hpp"
#include "commands.hpp"
#include "doctor/check.hpp"
#include "doctor/probe.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "lab_commands/lab_commands.hpp"
#include "scene/simd_kernels.hpp"

namespace hypotrack::app {
namespace {

using doctor::Check;
using doctor::State;

std::vector<Check> check_processor() {
  const int cores = core_count();
  return {{.name = "SIMD", .found = fmt::format("{} of {}", simd_target(), processor_name())},
          {.name = "threads",
           .found = fmt::format("{}, as many as cores that this process may use", cores)}};
}

/// Checks that a file comes with this installation.
Check check_data() {
  Check check{.name = "data", .needed = true};
  try {
    check.found = data_file("configs/trackers/real.yaml").parent_path().parent_path().string();
  } catch (const DataError& e) {
    check.state = State::missing;
    check.found = e.what();
    check.fix = doctor::kInstallCompletely;
  }
  return check;
}

/// Returns true if a program is on PATH.
bool is_on_path(std::string_view program) {
  const char* variable = std::getenv("PATH");
  std::string_view rest = variable ? variable : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const std::filesystem::path file = std::filesystem::path(rest.substr(0, end)) / program;
    if (access(file.c_str(), X_OK) == 0) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

Check check_lab() {
  Check check{.name = "lab commands", .found = "compare, bench, reliability, report"};
  if (const LabAbsence& absence = lab().absence; !absence.why.empty()) {
    check.state = State::missing;
    check.found = "compare, bench, reliability and report are absent: " + absence.why;
    check.fix = absence.fix;
  }
  return check;
}

/// Checks the programs that make SVG and PNG files of a report's plots.
Check check_report_images() {
  Check check{.name = "plots as images", .found = "node, rsvg-convert"};
  std::string missing, packages;
  for (const auto& [program, package] :
       {std::pair("node", "nodejs"), std::pair("rsvg-convert", "librsvg2-bin")}) {
    if (is_on_path(program)) continue;
    missing += fmt::format("{}{}", missing.empty() ? "" : ", ", program);
    packages += fmt::format(" {}", package);
  }
  if (missing.empty()) return check;
  check.state = State::missing;
  check.found = "not on PATH: " + missing;
  check.fix = "sudo apt-get install" + packages;
  return check;
}

std::vector<Check> all_checks(const CommonOptions& common) {
  std::vector<Check> checks = check_processor();
  checks.push_back(doctor::run_probe(
      {.name = "OpenGL",
       .word = "opengl",
       .needed = true,
       .if_it_crashes =
           "update the driver, or take Mesa's software renderer: export "
           "__EGL_VENDOR_LIBRARY_FILENAMES=/usr/share/glvnd/egl_vendor.d/50_mesa.json"}));
  checks.push_back(
      doctor::run_probe({.name = "CUDA",
                         .word = "cuda",
                         .if_it_crashes = "update NVIDIA's driver, or write `evaluate: "
                                          "{backend: cpu}` into scenes"}));
  checks.push_back(
      doctor::run_probe({.name = "video",
                         .word = "video",
                         .needed = true,
                         .if_it_crashes = "take Debian's OpenCV (libopencv-dev), or run with "
                                          "--set output.overlay=false"}));
  checks.push_back(doctor::run_probe({.name = "hand detector",
                                      .word = "hand_detector",
                                      .if_it_crashes = "hypotrack get detector"}));
  checks.push_back(doctor::check_cameras("/dev", "/sys/class/video4linux"));
  checks.push_back(check_data());
  std::ranges::copy(doctor::check_plugins(common.plugin_path), std::back_inserter(checks));
  checks.push_back(check_lab());
  checks.push_back(check_report_images());
  return checks;
}

}  // namespace

void add_doctor_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto json = std::make_shared<bool>(false);
  const Command command = root.add_command(
      "doctor", "Check this machine and installation: drivers, codecs, plugins, cameras");
  command.add("--json", json.get(), "Print the checks as JSON");
  command.on_call([=, &common, &exit_code] {
    const std::vector<Check> checks = all_checks(common);
    fmt::print("{}", *json ? doctor::json_of(checks) : doctor::text_of(checks));
    exit_code = doctor::is_ready(checks) ? 0 : 1;
  });
}

}  // namespace hypotrack::app
