#pragma once

#include <string>

#include "hypotrack/mesh_io.hpp"
#include "rig.hpp"

namespace hypotrack::test {

/// A hand of sticks, imported: bones `wrist` and `index_1` to `index_3`, `index_tip` and so on for
/// the five fingers, each holding one small triangle at its joint; the file's axes are the hand's.
/// Fingers run along +Y except that the index finger is abducted by 12 degrees and flexed by 20, 30
/// and 10; the thumb lies as its zero says.
ImportedMesh stick_hand();

/// The rig of stick_hand(), as YAML. Tests change parts of it.
std::string stick_rig();

Rig parse_rig(const std::string& yaml);

/// The message with which rigging the stick hand fails; fails the test if it does not.
std::string rig_error(const std::string& yaml);

/// `text` with the first occurrence of `from` replaced; fails the test if there is none.
std::string replaced(std::string text, const std::string& from, const std::string& to);

}  // namespace hypotrack::test
