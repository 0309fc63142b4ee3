#pragma once

#include "hypotrack/plugin/model.hpp"

namespace hypotrack {

/// Removes everything with y < `limit` from a mesh and closes the holes with flat caps, so that it
/// stays watertight. New vertices lie on the cut edges, with the bone influences of the end that is
/// kept. Throws DataError, naming `where`, if nothing is left.
void cut_below(Mesh& mesh, double limit, const std::string& where);

}  // namespace hypotrack
