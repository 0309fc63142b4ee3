#pragma once

#include "hypotrack/mesh_io.hpp"

namespace hypotrack::test {

/// A hand of sticks, imported: bones `wrist` and `index_1` to `index_3`, `index_tip` and so on for
/// the five fingers, each holding one small triangle at its joint; the file's axes are the hand's.
/// Fingers run along +Y except that the index finger is abducted by 12 degrees and flexed by 20, 30
/// and 10; the thumb lies as its zero says.
ImportedMesh stick_hand();

}  // namespace hypotrack::test
