#include "hypotrack/clicks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "hypotrack/error.hpp"
#include "hypotrack/params.hpp"

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
  void visit(ParamVisitor& v) {
    v("clicks", clicks, {.help = "landmarks marked in both views", .required = true});
  }
};

}  // namespace

std::vector<Click> read_clicks(const ConfigNode& node) {
  std::vector<Click> out;
  for (ClickParams& one : ParamReader(node).read<ClicksFile>().clicks)
    out.push_back(std::move(one.click));
  return out;
}

std::string clicks_yaml(std::span<const Click> clicks) {
  std::string out = clicks.empty() ? "clicks: []\n" : "clicks:\n";
  for (const Click& c : clicks)
    out += fmt::format("  - {{landmark: {}, left: [{:.1f}, {:.1f}], right: [{:.1f}, {:.1f}]}}\n",
                       c.landmark, c.left.x(), c.left.y(), c.right.x(), c.right.y());
  return out;
}

std::shared_ptr<const Model> clickable(const std::shared_ptr<const Model>& model) {
  constexpr float kAtCorner = 1e-4F;  // metres
  if (model->poses_itself() || model->dimension() != kPoseSize) return model;
  ModelData data = model->data();
  const Eigen::Matrix3Xf& vertices = data.mesh.vertices;
  const Eigen::Vector3f low = vertices.rowwise().minCoeff(), high = vertices.rowwise().maxCoeff();
  for (const int x : {0, 1})
    for (const int y : {0, 1})
      for (const int z : {0, 1}) {
        const Eigen::Vector3f corner(x ? high.x() : low.x(), y ? high.y() : low.y(),
                                     z ? high.z() : low.z());
        if ((vertices.colwise() - corner).colwise().norm().minCoeff() > kAtCorner) return model;
        data.landmarks.push_back({fmt::format("corner_{}{}{}", x, y, z), 0, corner.cast<double>()});
      }
  return std::make_shared<Model>(std::move(data));
}

int clicks_needed(const Model& model) { return model.dimension() == kPoseSize ? 3 : 4; }

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
