// hypotrack_doctor_probe WHAT: makes one check of `hypotrack doctor` that may crash, in a process
// of its own, and writes it as JSON to file descriptor 3.
#include <sys/resource.h>
#include <unistd.h>

#include <exception>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "base/standard_streams.hpp"
#include "doctor/probe.hpp"

namespace hypotrack::doctor {
namespace {

Check made(Check (*make)()) {
  try {
    return make();
  } catch (const std::exception& e) {
    return {.state = State::broken, .found = e.what()};
  }
}

/// Writes the report. Returns whether all of it was written.
bool report(const Check& check) {
  const nlohmann::json json = {
      {"state", word_of(check.state)}, {"found", check.found}, {"fix", check.fix}};
  const std::string text = json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  return write(kReportDescriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

}  // namespace
}  // namespace hypotrack::doctor

int main(int argc, char** argv) {
  using namespace hypotrack::doctor;
  hypotrack::open_standard_streams();
  const std::map<std::string, Check (*)()> probes = {{"opengl", probe_opengl},
                                                     {"cuda", probe_cuda},
                                                     {"video", probe_video},
                                                     {"hand_detector", probe_hand_detector}};
  const auto probe = argc == 2 ? probes.find(argv[1]) : probes.end();
  if (probe == probes.end()) return 2;
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);               // crashes are expected here
  _exit(report(made(probe->second)) ? 0 : 2);  // skips the destructors of drivers
}
