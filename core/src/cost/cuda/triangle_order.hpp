#pragma once

#include <vector>

#include "hypotrack/model.hpp"

namespace hypotrack::cuda {

/// Triangle numbers in an order in which neighbours lie close together on the same side of the
/// surface, so that the warp that looks at them mostly finds all of them visible or none.
std::vector<int> order_by_place(const Mesh& mesh);

}  // namespace hypotrack::cuda
