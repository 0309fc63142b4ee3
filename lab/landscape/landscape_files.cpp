#include "lab/landscape/landscape_files.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/csv.hpp"
#include "base/text_file.hpp"

namespace hypotrack::internal {
namespace {

std::string curve_names(const Landscape& landscape) {
  std::string text;
  for (const std::string& name : landscape.curves) text += "," + csv_cell(name);
  return text + "\n";
}

/// Returns the costs of a point; an empty cell is infeasible.
std::string costs_of(const LandscapeSlice& slice, Eigen::Index point) {
  std::string text;
  for (const double cost : slice.costs.row(point))
    text += std::isfinite(cost) ? fmt::format(",{}", cost) : ",";
  return text + "\n";
}

std::string offset_of(const LandscapeAxis& axis, Eigen::Index i) {
  return fmt::format("{},{},{:.6g}", csv_cell(axis.name), axis.unit,
                     axis.offsets[i] * axis.to_unit);
}

}  // namespace

std::string slices_csv(const Landscape& landscape) {
  std::string text = "parameter,unit,offset" + curve_names(landscape);
  for (const LandscapeSlice& slice : landscape.lines)
    for (Eigen::Index i = 0; i < slice.costs.rows(); ++i)
      text += offset_of(landscape.axes[slice.x], i) + costs_of(slice, i);
  return text;
}

std::string pairs_csv(const Landscape& landscape) {
  std::string text =
      "parameter,unit,offset,other_parameter,other_unit,other_offset" + curve_names(landscape);
  for (const LandscapeSlice& slice : landscape.pairs) {
    const LandscapeAxis &x = landscape.coarse_axes[slice.x], &y = landscape.coarse_axes[slice.y];
    for (Eigen::Index i = 0; i < slice.costs.rows(); ++i)
      text += offset_of(x, i % x.offsets.size()) + "," + offset_of(y, i / x.offsets.size()) +
              costs_of(slice, i);
  }
  return text;
}

void write_landscape(const Landscape& landscape, const std::string& title,
                     const std::filesystem::path& folder) {
  make_folder(folder);
  const std::size_t figures = landscape.curves.size() == 2 ? 1 : landscape.curves.size();
  for (std::size_t curve = 0; curve < figures; ++curve) {
    const std::string& name = landscape.curves[curve];
    const std::string heading = curve == 0 ? title : fmt::format("{}: {}", title, name);
    write_whole(folder / (name + ".svg"), landscape_svg(landscape, curve, heading));
  }
  write_whole(folder / "slices.csv", slices_csv(landscape));
  write_whole(folder / "pairs.csv", pairs_csv(landscape));
}

}  // namespace hypotrack::internal
