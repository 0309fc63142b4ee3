#include "lab/report/plots/reliability_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/svg.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kLow = 0.125, kHigh = 128;  // mm, both axes
constexpr double kLeft = 64, kTop = 44, kSide = 360;

double along(double mm) {
  return std::log(std::clamp(mm, kLow, kHigh) / kLow) / std::log(kHigh / kLow);
}
double x_of(double mm) { return kLeft + kSide * along(mm); }
double y_of(double mm) { return kTop + kSide * (1 - along(mm)); }

std::string axes() {
  std::string out;
  for (double mm = kLow; mm <= kHigh; mm *= 2) {
    constexpr const char* kGrid = R"(stroke="#e4e4e4")";
    out += svg_line(x_of(mm), y_of(kLow), x_of(mm), y_of(kHigh), kGrid);
    out += svg_line(x_of(kLow), y_of(mm), x_of(kHigh), y_of(mm), kGrid);
    out += svg_text(x_of(mm), y_of(kLow) + 16, fmt::format("{:g}", mm));
    out += svg_text(x_of(kLow) - 22, y_of(mm) + 4, fmt::format("{:g}", mm));
  }
  out += svg_line(x_of(kLow), y_of(kLow), x_of(kHigh), y_of(kHigh),
                  R"(stroke="#888" stroke-dasharray="5 4")");
  out += svg_text(kLeft + kSide / 2, kTop + kSide + 36, "sigma, root mean square (mm)");
  const double middle = kTop + kSide / 2;
  out +=
      svg_text(16, middle, "error, root mean square (mm)",
               fmt::format(R"x(text-anchor="middle" transform="rotate(-90 16 {:.1f})")x", middle));
  return out;
}

std::string dots(const Reliability& reliability) {
  std::string out;
  std::string path;
  for (const ReliabilityBin& bin : reliability.bins()) {
    if (bin.count == 0) continue;
    const double x = x_of(1000 * bin.sigma), y = y_of(1000 * bin.error);
    const double share = static_cast<double>(bin.count) / static_cast<double>(reliability.count());
    path += fmt::format("{:.1f},{:.1f} ", x, y);
    out += fmt::format(
        R"(<circle cx="{:.1f}" cy="{:.1f}" r="{:.1f}" fill="#1f6fb4" fill-opacity="0.8">)"
        "<title>{} landmarks</title></circle>\n",
        x, y, 3 + 18 * std::sqrt(share), bin.count);
  }
  return fmt::format(R"(<polyline points="{}" fill="none" stroke="#1f6fb4"/>)"
                     "\n",
                     path) +
         out;
}

}  // namespace

std::string reliability_svg(const Reliability& reliability, const std::string& title) {
  const std::string shares = fmt::format(
      "{} landmarks; {:.0f} % within one sigma, {:.0f} % two, {:.0f} % three", reliability.count(),
      100 * reliability.within(1), 100 * reliability.within(2), 100 * reliability.within(3));
  const double width = kLeft + kSide + 24, height = kTop + kSide + 52;
  return fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" )"
                     R"(viewBox="0 0 {0} {1}" font-family="sans-serif" font-size="11">)"
                     "\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
                     width, height) +
         svg_text(kLeft + kSide / 2, 18, svg_escaped(title),
                  R"(text-anchor="middle" font-size="14")") +
         svg_text(kLeft + kSide / 2, 34, shares) + axes() + dots(reliability) + "</svg>\n";
}

}  // namespace hypotrack::internal
