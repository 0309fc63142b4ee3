#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lab/landscape/landscape_files.hpp"
#include "lab/svg.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kWidth = 150, kHeight = 90;  // of a panel with a line
constexpr double kSquare = 104;               // of a panel of a pair
constexpr double kGapX = 62, kGapY = 54, kMargin = 64, kHead = 64;
constexpr int kColumns = 6;
constexpr double kPageWidth = kMargin + kColumns * (kWidth + kGapX);
constexpr int kPairColumns = static_cast<int>((kPageWidth - kMargin) / (kSquare + kGapX));

constexpr const char* kBold = R"(text-anchor="middle" font-weight="600")";
constexpr const char* kEnd = R"(text-anchor="end")";

struct CostRange {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();
  void add(double value) {
    if (!std::isfinite(value)) return;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  bool empty() const { return lowest > highest; }
  /// Returns the place of a value, from 0 to 1; the middle if all are equal.
  double share(double value) const {
    return highest > lowest ? (value - lowest) / (highest - lowest) : 0.5;
  }
};

CostRange cost_range(const Eigen::Ref<const Eigen::VectorXd>& values) {
  CostRange range;
  for (const double value : values) range.add(value);
  return range;
}

std::string dot(double x, double y) {
  return fmt::format(
      "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"#c8440a\" stroke=\"white\"/>\n", x, y);
}

/// Returns the point of lowest cost; of equal ones the nearest to the centre, -1 if none is
/// feasible. `distance` is that of a point from the centre.
template <class Distance>
Eigen::Index lowest(const Eigen::Ref<const Eigen::VectorXd>& costs, const Distance& distance) {
  Eigen::Index best = -1;
  for (Eigen::Index i = 0; i < costs.size(); ++i) {
    if (!std::isfinite(costs[i])) continue;
    if (best < 0 || costs[i] < costs[best] ||
        (costs[i] == costs[best] && distance(i) < distance(best)))
      best = i;
  }
  return best;
}

/// Returns a colour of viridis (van der Walt and Smith 2015) by linear interpolation.
std::string viridis(double share) {
  constexpr std::array<std::array<double, 3>, 5> kStops{
      {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};
  const double at = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  std::array<int, 3> rgb{};
  for (std::size_t c = 0; c < 3; ++c)
    rgb[c] = static_cast<int>(std::lround(kStops[i][c] + (at - static_cast<double>(i)) *
                                                             (kStops[i + 1][c] - kStops[i][c])));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

/// A panel's axis: offsets in their unit.
struct Along {
  explicit Along(const LandscapeAxis& axis)
      : from(axis.offsets[0] * axis.to_unit),
        to(axis.offsets[axis.offsets.size() - 1] * axis.to_unit) {}
  double from, to;
  double share(double offset) const { return to > from ? (offset - from) / (to - from) : 0.5; }
};

std::string ticks(double left, double width, double y, const Along& along,
                  const LandscapeAxis& axis) {
  std::string out = svg_text(left, y, fmt::format("{:.0f}", along.from)) +
                    svg_text(left + width, y, fmt::format("{:.0f} {}", along.to, axis.unit));
  const double zero = along.share(0);
  if (zero > 0.2 && zero < 0.8) out += svg_text(left + zero * width, y, "0");
  return out;
}

std::string line_panel(const Landscape& all, const LandscapeSlice& slice, std::size_t curve,
                       double left, double top) {
  const LandscapeAxis& axis = all.axes[slice.x];
  const Along along(axis);
  const auto costs = slice.costs.col(static_cast<Eigen::Index>(curve));
  CostRange range = cost_range(costs);
  range.add(all.centre[static_cast<Eigen::Index>(curve)]);
  std::string out = svg_text(left + kWidth / 2, top - 6, svg_escaped(axis.name), kBold);
  out += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\" fill=\"none\" "
      "stroke=\"#c9cfd8\"/>\n",
      left, top, kWidth, kHeight);
  out += ticks(left, kWidth, top + kHeight + 13, along, axis);
  const double zero = left + kWidth * along.share(0);
  out += svg_line(zero, top, zero, top + kHeight, R"(stroke="#566074" stroke-dasharray="4 3")");
  if (range.empty()) return out + svg_text(left + kWidth / 2, top + kHeight / 2, "infeasible");
  out += svg_text(left - 4, top + kHeight, fmt::format("{:.4g}", range.lowest), kEnd);
  out += svg_text(left - 4, top + 9, fmt::format("{:.4g}", range.highest), kEnd);
  const auto x_of = [&](Eigen::Index i) {
    return left + kWidth * along.share(axis.offsets[i] * axis.to_unit);
  };
  const auto y_of = [&](double cost) { return top + kHeight * (1 - range.share(cost)); };
  std::string path;
  bool draws = false;
  for (Eigen::Index i = 0; i < costs.size(); ++i) {
    if (!std::isfinite(costs[i])) {
      draws = false;
      continue;
    }
    path += fmt::format("{}{:.1f} {:.1f} ", draws ? 'L' : 'M', x_of(i), y_of(costs[i]));
    draws = true;
  }
  const Eigen::Index best =
      lowest(costs, [&](Eigen::Index i) { return std::abs(axis.offsets[i]); });
  out +=
      fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"#1668b8\" stroke-width=\"1.6\"/>\n", path);
  if (best >= 0) out += dot(x_of(best), y_of(costs[best]));
  return out;
}

std::string pair_panel(const Landscape& all, const LandscapeSlice& slice, std::size_t curve,
                       double left, double top) {
  const LandscapeAxis &x_axis = all.coarse_axes[slice.x], &y_axis = all.coarse_axes[slice.y];
  const Along x_along(x_axis), y_along(y_axis);
  const auto costs = slice.costs.col(static_cast<Eigen::Index>(curve));
  const CostRange range = cost_range(costs);
  const Eigen::Index columns = x_axis.offsets.size(), rows = y_axis.offsets.size();
  const double width = kSquare / static_cast<double>(columns),
               height = kSquare / static_cast<double>(rows);
  std::string out = svg_text(left + kSquare / 2, top - 17, svg_escaped(x_axis.name), kBold);
  out += svg_text(left + kSquare / 2, top - 6, "and up: " + svg_escaped(y_axis.name));
  for (Eigen::Index r = 0; r < rows; ++r)
    for (Eigen::Index c = 0; c < columns; ++c) {
      const Eigen::Index i = r * columns + c;
      if (!std::isfinite(costs[i])) continue;
      out += fmt::format(
          "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\" "
          "shape-rendering=\"crispEdges\"/>\n",
          left + width * static_cast<double>(c),
          top + kSquare - height * static_cast<double>(r + 1), width + 0.3, height + 0.3,
          viridis(range.share(costs[i])));
    }
  const Eigen::Index best = lowest(costs, [&](Eigen::Index i) {
    return std::hypot(
        x_along.share(x_axis.offsets[i % columns] * x_axis.to_unit) - x_along.share(0),
        y_along.share(y_axis.offsets[i / columns] * y_axis.to_unit) - y_along.share(0));
  });
  out += ticks(left, kSquare, top + kSquare + 13, x_along, x_axis);
  out += svg_text(left - 4, top + kSquare, fmt::format("{:.0f}", y_along.from), kEnd);
  out += svg_text(left - 4, top + 9, fmt::format("{:.0f}", y_along.to), kEnd);
  // Cells have their middles at the offsets.
  const auto place = [](double share, Eigen::Index count) {
    return (share * static_cast<double>(count - 1) + 0.5) / static_cast<double>(count);
  };
  const double x0 = left + kSquare * place(x_along.share(0), columns);
  const double y0 = top + kSquare * (1 - place(y_along.share(0), rows));
  out += svg_line(x0 - 6, y0, x0 + 6, y0, R"(stroke="white" stroke-width="1.6")");
  out += svg_line(x0, y0 - 6, x0, y0 + 6, R"(stroke="white" stroke-width="1.6")");
  if (best >= 0)
    out += dot(left + width * (static_cast<double>(best % columns) + 0.5),
               top + kSquare - height * (static_cast<double>(best / columns) + 0.5));
  return out;
}

}  // namespace

std::string landscape_svg(const Landscape& all, std::size_t curve, const std::string& title) {
  std::string body;
  double top = kHead;
  const auto place = [&](const std::vector<LandscapeSlice>& slices, int columns, double width,
                         double height, double gap, const auto& panel) {
    for (std::size_t i = 0; i < slices.size(); ++i) {
      const auto column = static_cast<int>(i % static_cast<std::size_t>(columns));
      if (i > 0 && column == 0) top += height + gap;
      body += panel(all, slices[i], curve, kMargin + column * (width + kGapX), top);
    }
    if (!slices.empty()) top += height + gap;
  };
  place(all.lines, kColumns, kWidth, kHeight, kGapY - 8, line_panel);
  top += 14;
  place(all.pairs, kPairColumns, kSquare, kSquare, kGapY, pair_panel);
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1:.0f}\" "
             "viewBox=\"0 0 {0} {1:.0f}\" font-family=\"sans-serif\" font-size=\"10\">\n"
             "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
             kPageWidth, top) +
         svg_text(kMargin, 22, svg_escaped(title), R"(font-size="15")") +
         svg_text(
             kMargin, 38,
             "Dashed line, cross: the centre. Dot: the lowest cost of a panel. Dark is low; each "
             "panel has its own range.",
             "") +
         body + "</svg>\n";
}

}  // namespace hypotrack::internal
