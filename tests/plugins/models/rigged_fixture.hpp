#pragma once

#include <string>

#include "rig.hpp"
#include "stick_hand.hpp"

namespace hypotrack::test {

/// The rig of stick_hand(), as YAML. Tests change parts of it.
std::string stick_rig();

Rig parse_rig(const std::string& yaml);

/// The message with which rigging the stick hand fails; fails the test if it does not.
std::string rig_error(const std::string& yaml);

/// `text` with the first occurrence of `from` replaced; fails the test if there is none.
std::string replaced(std::string text, const std::string& from, const std::string& to);

}  // namespace hypotrack::test
