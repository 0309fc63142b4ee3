#include <filesystem>

#include "doctor/probe.hpp"
#include "hand_detector.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::doctor {

Check probe_hand_detector() {
  const std::string command = "hypotrack get detector";
  try {
    const std::filesystem::path folder = HandDetector::default_folder();
    const bool any = std::filesystem::is_directory(folder);
    try {
      (void)HandDetector({.folder = folder});
      return {.found = folder.string() + ": its networks load"};
    } catch (const DataError& e) {
      return {.state = any ? State::broken : State::missing, .found = e.what(), .fix = command};
    }
  } catch (const DataError& e) {
    return {.state = State::missing, .found = e.what(), .fix = "set HOME, then run " + command};
  }
}

}  // namespace hypotrack::doctor
