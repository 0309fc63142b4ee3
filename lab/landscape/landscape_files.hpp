#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "base/exported.hpp"
#include "lab/landscape/landscape.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Writes sum.svg, <term>.svg for each of several terms, slices.csv and pairs.csv into a folder,
/// which it makes. `title` heads the figures. Throws OutputError.
void write_landscape(const Landscape& landscape, const std::string& title,
                     const std::filesystem::path& folder);

/// Returns the lines of slices.csv: parameter, unit, offset and a column per curve.
std::string slices_csv(const Landscape& landscape);
/// Returns the lines of pairs.csv: two parameters with unit and offset, and a column per curve.
std::string pairs_csv(const Landscape& landscape);

}  // namespace internal
inline namespace HYPOTRACK_EXPORTED internal {

/// Draws a curve of a landscape as SVG: a panel per parameter, then one per pair of them. Each
/// panel has the range of its own costs; a dashed line or a cross is the centre, a dot the lowest
/// cost. Infeasible points are left out.
std::string landscape_svg(const Landscape& landscape, std::size_t curve, const std::string& title);

}  // namespace internal
}  // namespace hypotrack
