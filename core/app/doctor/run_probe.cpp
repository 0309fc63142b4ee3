#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <system_error>

#include "base/subprocess.hpp"
#include "doctor/probe.hpp"
#include "plugin/folders.hpp"

namespace hypotrack::doctor {
namespace {

State state_of(const nlohmann::json& report) {
  const std::string word = report.value("state", "");
  if (word == word_of(State::ok)) return State::ok;
  return word == word_of(State::missing) ? State::missing : State::broken;
}

/// Describes the failure of a child process that made no report.
std::string describe_end(const Captured& captured, const Probe& probe) {
  if (captured.timed_out)
    return fmt::format("hung: no answer within {:g} s",
                       static_cast<double>(probe.limit.count()) / 1e3);
  if (captured.end.signal) return "crashed: " + signal_name(captured.end.signal);
  return fmt::format("ended its process with exit code {}", captured.end.code);
}

}  // namespace

Check run_probe(const Probe& probe) {
  Check check{.name = probe.name, .state = State::broken, .needed = probe.needed};
  try {
    const Captured captured =
        capture_output({detail::libexec_program("hypotrack_doctor_probe"), {probe.word}},
                       {kReportDescriptor}, {probe.limit});
    const auto report = nlohmann::json::parse(captured.output, nullptr, false);
    if (report.is_object()) {
      check.state = state_of(report);
      check.found = report.value("found", "");
      check.fix = report.value("fix", "");
      if (check.fix.empty()) check.fix = probe.if_it_crashes;
    } else {
      check.found = describe_end(captured, probe);
      check.fix = probe.if_it_crashes;
    }
  } catch (const std::system_error& error) {
    check.found = error.what();
    check.fix = kInstallCompletely;
  }
  return check;
}

}  // namespace hypotrack::doctor
