#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <filesystem>

namespace hypotrack::articulated {

/// Parses a URDF file by urdfdom. Throws DataError with the file's name and what urdfdom logs, if
/// it logs a warning or an error.
urdf::ModelInterfaceSharedPtr parse_urdf(const std::filesystem::path& file);

}  // namespace hypotrack::articulated
