#pragma once

#include "hypotrack/api/mesh_io.hpp"

namespace hypotrack::test {

/// Returns an imported hand of sticks. Its bones are `wrist` and, for each finger, `index_1` to
/// `index_3` and `index_tip`. Each holds one small triangle at its joint. The file's axes are the
/// hand's. Fingers run along +Y, but the index finger is abducted by 12 degrees and flexed by 20,
/// 30 and 10. The thumb lies as its zero says.
ImportedMesh stick_hand();

}  // namespace hypotrack::test
