#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace hypotrack::articulated {

/// Parses a URDF file by urdfdom. Throws DataError with the file's name and what urdfdom logs, if
/// it logs a warning or an error. `notes` receives what is not read.
urdf::ModelInterfaceSharedPtr parse_urdf(const std::filesystem::path& file,
                                         std::vector<std::string>& notes);

/// Returns a note that lists the elements and attributes of a URDF text that are not read. Those
/// that neither move nor show anything have none: <inertial>, <collision>, <dynamics>,
/// <calibration>.
std::vector<std::string> unread_in_urdf(const std::string& text);

}  // namespace hypotrack::articulated
