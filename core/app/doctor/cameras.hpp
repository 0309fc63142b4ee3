#pragma once

#include <filesystem>

#include "doctor/check.hpp"

namespace hypotrack::doctor {

/// Lists video devices with their names. `devices` is /dev, `classes` /sys/class/video4linux.
Check check_cameras(const std::filesystem::path& devices, const std::filesystem::path& classes);

}  // namespace hypotrack::doctor
