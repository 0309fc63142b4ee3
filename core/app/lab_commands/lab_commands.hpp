#pragma once

#include <memory>
#include <string>

#include "commands.hpp"
#include "lab/live/live_view.hpp"

namespace hypotrack::app {

/// Adds the lab's commands and opens its page. A module of its own has these functions, so that the
/// program runs without the lab's libraries.
struct LabCommands {
  void (*add_fit_judge)(const Command& root, CommonOptions& common, int& exit_code);
  void (*add_reliability)(const Command& root, int& exit_code);
  void (*add_compare)(const Command& root, CommonOptions& common, int& exit_code);
  void (*add_bench)(const Command& root, CommonOptions& common, int& exit_code);
  void (*add_report)(const Command& root, CommonOptions& common, int& exit_code);
  void (*add_landscape)(const Command& root, CommonOptions& common, int& exit_code);
  std::unique_ptr<LiveView> (*open_live_view)(const LiveViewOptions& options,
                                              RunControls& controls);
};

/// Name and type of the function that the module exports.
inline constexpr const char* kGetLabCommands = "hypotrack_lab_commands";
using GetLabCommands = const LabCommands& (*)();

/// Says why the lab is absent and what helps; both are empty where it is there.
struct LabAbsence {
  std::string why = {}, fix = {};
};

/// The lab's functions, or such as throw ConfigError with the reason of their absence.
struct Lab {
  LabAbsence absence = {};
  const LabCommands* commands = nullptr;
};

/// Loads the lab's module once.
const Lab& lab();

/// Returns functions that say that the lab is absent.
const LabCommands& absent_lab_commands();

}  // namespace hypotrack::app
