#include "lab/landscape/landscape.hpp"

#include <algorithm>

namespace hypotrack::internal {
namespace {

SearchSettings rotation_vectors() {
  SearchSettings settings;
  settings.rotation_as = RotationCoordinates::tangent;
  return settings;
}

/// The dimensions of search points that are sliced.
class Slicer {
 public:
  Slicer(const Scene& scene, const Eigen::VectorXd& state, const TermCosts& costs,
         const LandscapeSettings& settings)
      : scene_(scene),
        state_(state),
        costs_(costs),
        settings_(settings),
        space_(scene, rotation_vectors(), settings.models),
        region_(space_.region(state)) {}

  std::vector<LandscapeAxis> axes(int points) const {
    std::vector<LandscapeAxis> out;
    for (std::size_t m = 0; m < scene_.items().size(); ++m) {
      if (!settings_.models.empty() && !settings_.models[m]) continue;
      const Scene::Item& item = scene_.items()[m];
      for (int i = 0; i < item.model->dimension(); ++i) {
        const Parameter& p = scene_.parameters()[static_cast<std::size_t>(item.offset + i)];
        if (p.kind != ParameterKind::quaternion) {
          add_axis(p.name, p.kind, points, out);
          continue;
        }
        for (const char* axis : {"x", "y", "z"})
          add_axis(item.name + ".turn_" + axis, p.kind, points, out);
        i += 3;
      }
    }
    return out;
  }

  /// Returns whether two dimensions belong to one pose or limb.
  bool together(std::size_t a, std::size_t b) const {
    return std::ranges::any_of(region_.groups, [&](const SearchGroup& group) {
      const auto has = [&](std::size_t d) {
        return std::ranges::find(group.dimensions, static_cast<int>(d)) != group.dimensions.end();
      };
      return has(a) && has(b);
    });
  }

  LandscapeSlice slice(const std::vector<LandscapeAxis>& axes, std::size_t x, std::size_t y) const {
    const Eigen::VectorXd& along = axes[x].offsets;
    const Eigen::Index rows = x == y ? 1 : axes[y].offsets.size();
    Eigen::MatrixXd points = region_.start.replicate(1, along.size() * rows);
    for (Eigen::Index r = 0; r < rows; ++r)
      for (Eigen::Index c = 0; c < along.size(); ++c) {
        auto point = points.col(r * along.size() + c);
        point[static_cast<Eigen::Index>(x)] += along[c];
        if (x != y) point[static_cast<Eigen::Index>(y)] += axes[y].offsets[r];
      }
    return {x, y, with_sum(costs_(space_.states(points, state_)))};
  }

  Eigen::VectorXd centre() const { return with_sum(costs_(state_)).row(0); }

 private:
  static Eigen::MatrixXd with_sum(const Eigen::MatrixXd& terms) {
    Eigen::MatrixXd out(terms.rows(), terms.cols() + 1);
    out << terms.rowwise().sum(), terms;
    return out;
  }

  void add_axis(const std::string& name, ParameterKind kind, int points,
                std::vector<LandscapeAxis>& axes) const {
    const auto d = static_cast<Eigen::Index>(axes.size());
    const bool is_length = is_in_metres(kind);
    const double reach = is_length ? settings_.position : settings_.rotation;
    const double from = std::max(-reach, region_.lower[d] - region_.start[d]);
    const double to = std::min(reach, region_.upper[d] - region_.start[d]);
    axes.push_back({name, is_length ? "mm" : "deg", 1 / (is_length ? kMillimetre : kDegree),
                    Eigen::VectorXd::LinSpaced(points, from, to)});
  }

  const Scene& scene_;
  const Eigen::VectorXd& state_;
  const TermCosts& costs_;
  const LandscapeSettings& settings_;
  SearchSpace space_;
  SearchRegion region_;
};

}  // namespace

Landscape measure_landscape(const Scene& scene, const Eigen::VectorXd& state,
                            const std::vector<std::string>& terms, const TermCosts& costs,
                            const LandscapeSettings& settings) {
  const Slicer slicer(scene, state, costs, settings);
  Landscape out;
  out.curves = terms;
  out.curves.insert(out.curves.begin(), "sum");
  out.centre = slicer.centre();
  out.axes = slicer.axes(settings.points);
  out.coarse_axes = slicer.axes(settings.grid);
  for (std::size_t x = 0; x < out.axes.size(); ++x)
    out.lines.push_back(slicer.slice(out.axes, x, x));
  for (std::size_t x = 0; x < out.axes.size(); ++x)
    for (std::size_t y = x + 1; y < out.axes.size(); ++y)
      if (settings.all_pairs || slicer.together(x, y))
        out.pairs.push_back(slicer.slice(out.coarse_axes, x, y));
  return out;
}

}  // namespace hypotrack::internal
