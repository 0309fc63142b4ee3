#pragma once

#include <string>
#include <vector>

namespace hypotrack::articulated {

/// Returns a note that lists the elements and attributes of a URDF text that are not read. Those
/// that neither move nor show anything have none: <inertial>, <collision>, <dynamics>,
/// <calibration>.
std::vector<std::string> unread_in_urdf(const std::string& text);

}  // namespace hypotrack::articulated
