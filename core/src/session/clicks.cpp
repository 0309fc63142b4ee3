#include "hypotrack/api/clicks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {
namespace {

struct ClickParams {
  Click click;
  void visit(ParamVisitor& v) {
    v("landmark", click.landmark, {.help = "name of the landmark", .required = true});
    v("left", click.left, {.help = "x y in the first view", .unit = "px", .required = true});
    v("right", click.right, {.help = "x y in the second view", .unit = "px", .required = true});
  }
};

struct ClicksFile {
  std::vector<ClickParams> clicks;
  std::optional<int> frame;
  std::vector<std::string> pictures;
  void visit(ParamVisitor& v) {
    v("frame", frame, {.help = "index of the frame that was clicked", .min = 0});
    v("pictures", pictures, {.help = "summary of its two views, to recognize it"});
    v("clicks", clicks, {.help = "landmarks marked in both views", .required = true});
  }
};

}  // namespace

ClickedFrame read_clicks(const ConfigNode& node) {
  ClicksFile file = ParamReader(node).read<ClicksFile>();
  ClickedFrame out{{}, file.frame, std::move(file.pictures)};
  for (ClickParams& one : file.clicks) out.clicks.push_back(std::move(one.click));
  return out;
}

std::string clicks_yaml(const ClickedFrame& clicked) {
  std::string out;
  if (clicked.frame) out += fmt::format("frame: {}\n", *clicked.frame);
  if (!clicked.pictures.empty()) {
    out += "pictures:  # how its views look, so that a run that begins elsewhere is noticed\n";
    for (const std::string& picture : clicked.pictures) out += fmt::format("  - \"{}\"\n", picture);
  }
  out += clicked.clicks.empty() ? "clicks: []\n" : "clicks:\n";
  for (const Click& c : clicked.clicks)
    out += fmt::format("  - {{landmark: {}, left: [{:.1f}, {:.1f}], right: [{:.1f}, {:.1f}]}}\n",
                       c.landmark, c.left.x(), c.left.y(), c.right.x(), c.right.y());
  return out;
}

std::string describe(const ClickFit& fit) {
  std::string out;
  double sum = 0;
  for (const ClickResidual& r : fit.residuals) {
    out += fmt::format("; {} {:.1f} mm, {:.1f} px", r.landmark, 1000 * r.distance, r.pixels);
    sum += r.distance;
  }
  const auto count = static_cast<double>(fit.residuals.size());
  return fmt::format("{} clicks, {:.1f} mm from the fit on average{}", fit.residuals.size(),
                     1000 * sum / count, out);
}

}  // namespace hypotrack
