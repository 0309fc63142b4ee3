#pragma once

#include <filesystem>

#include "new_scene/scene_request.hpp"

namespace hypotrack::app {

/// Finds the pictures or videos of a pair, and its calibration, in a folder and two levels below.
/// Left and right are told by their names: left and right, or cam0 and cam1. Throws DataError if
/// there is no pair, or more than one.
RecordingFiles find_recording(const std::filesystem::path& folder);

/// Adds the calibration's second file if `intrinsics` and `extrinsics` lie side by side.
void add_extrinsics(RecordingFiles& files);

}  // namespace hypotrack::app
