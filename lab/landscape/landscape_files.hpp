#pragma once

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
}  // namespace hypotrack
