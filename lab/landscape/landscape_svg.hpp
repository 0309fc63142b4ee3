#pragma once

#include <cstddef>
#include <string>

#include "base/exported.hpp"
#include "lab/landscape/landscape.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Draws a curve of a landscape as SVG: a panel per parameter, then one per pair of them. Each
/// panel has the range of its own costs; a dashed line or a cross is the centre, a dot the lowest
/// cost. Infeasible points are left out.
std::string landscape_svg(const Landscape& landscape, std::size_t curve, const std::string& title);

}  // namespace internal
}  // namespace hypotrack
