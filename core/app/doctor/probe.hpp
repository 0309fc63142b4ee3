#pragma once

#include <chrono>
#include <string>

#include "doctor/check.hpp"

namespace hypotrack::doctor {

/// File descriptor of the probe program's report, separate from what drivers print.
inline constexpr int kReportDescriptor = 3;

/// A check that calls drivers or codecs, so that it runs in a child process.
struct Probe {
  std::string name;  ///< of the check
  std::string word;  ///< argument of the probe program
  bool needed = false;
  std::string if_it_crashes;  ///< the remedy then, or where the check knows none
  std::chrono::milliseconds limit{60'000};
};

/// Runs a check in a child process. A crash or hang there is a broken check.
Check run_probe(const Probe& probe);

// The checks, as the probe program makes them. Each leaves name and needed to run_probe().
Check probe_opengl();
Check probe_cuda();
Check probe_video();
Check probe_hand_detector();

}  // namespace hypotrack::doctor
