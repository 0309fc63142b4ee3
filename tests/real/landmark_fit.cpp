#include "landmark_fit.hpp"

#include <limits>
#include <memory>

#include "hypotrack/config.hpp"
#include "hypotrack/optimizer.hpp"
#include "metrics/landmark_errors.hpp"
#include "track/search_space.hpp"

namespace hypotrack::test {
namespace {

/// Landmarks of the model made `scale` times larger. Everything but its position scales with it.
Eigen::Matrix3Xd scaled_landmarks(const Scene& scene, const Eigen::VectorXd& state, double scale) {
  const Eigen::Vector3d position = state.head<3>();
  const Eigen::Matrix3Xd offsets = scene.landmarks(state).colwise() - position;
  return (scale * offsets).colwise() + position;
}

/// Mean squared distance of the known landmarks in mm^2, for search points of a pose with the scale
/// as one more number. A radian away from rest costs as much as (0.5 mm)^2, so that angles which no
/// landmark determines stay where they are.
class SquaredDistance final : public CostFunction {
 public:
  SquaredDistance(const Scene& scene, const SearchSpace& space, const Eigen::Matrix3Xd& truth,
                  const Eigen::VectorXd& prior)
      : scene_(scene), space_(space), truth_(truth), prior_(prior) {}

  int dimension() const override { return space_.dimension() + 1; }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override {
    const Eigen::MatrixXd states = space_.states(points.topRows(space_.dimension()), prior_);
    for (Eigen::Index n = 0; n < points.cols(); ++n)
      costs[n] = cost(states.col(n), points(space_.dimension(), n));
  }

 private:
  double cost(const Eigen::VectorXd& state, double scale) const {
    const Eigen::Matrix3Xd landmarks = scaled_landmarks(scene_, state, scale);
    double sum = 0;
    int known = 0;
    for (Eigen::Index i = 0; i < truth_.cols(); ++i) {
      if (truth_.col(i).array().isNaN().any()) continue;
      sum += 1e6 * (landmarks.col(i) - truth_.col(i)).squaredNorm();
      ++known;
    }
    const Eigen::VectorXd bent = (state - scene_.rest_state()).tail(state.size() - 7);
    return sum / known + 0.25 * bent.squaredNorm();
  }

  const Scene& scene_;
  const SearchSpace& space_;
  const Eigen::Matrix3Xd& truth_;
  const Eigen::VectorXd& prior_;
};

/// The search region of a pose with the scale as one more number.
SearchRegion with_scale(SearchRegion region, double scale) {
  const Eigen::Index d = region.start.size();
  for (auto* v : {&region.start, &region.lower, &region.upper, &region.spread})
    v->conservativeResize(d + 1);
  region.start[d] = scale;
  region.lower[d] = 0.5;
  region.upper[d] = 2;
  region.spread[d] = 0.1;
  return region;
}

}  // namespace

LandmarkFit fit_landmarks(const Scene& scene, const Eigen::Matrix3Xd& truth,
                          const Eigen::VectorXd& start, double start_scale, PluginLoader& plugins) {
  const auto optimizer = plugins.make<Optimizer>(ConfigNode::parse(
      "{type: nlopt, algorithm: BOBYQA, evaluations: 4000, tolerance: 1e-6}", "landmark fit"));
  SearchSettings settings;
  settings.rotation_as = RotationSearch::tangent;
  const SearchSpace space(scene, settings);
  LandmarkFit fit{start, start_scale};
  scene.normalize(fit.state);
  // Each round turns about the rotation that the one before has found.
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 20; ++round) {
    const Eigen::VectorXd prior = fit.state;
    SquaredDistance cost(scene, space, truth, prior);
    const OptimizerResult result = optimizer->minimize(
        cost, with_scale(space.region(prior), fit.scale), {optimizer->default_evaluations()}, 1);
    fit.state = space.states(result.point.head(space.dimension()), prior);
    fit.scale = result.point[space.dimension()];
    if (result.cost > 0.9999 * last) break;
    last = result.cost;
  }
  fit.mean_distance = frame_error(landmark_layout(scene.landmark_names()),
                                  scaled_landmarks(scene, fit.state, fit.scale), truth)
                          .mean;
  return fit;
}

}  // namespace hypotrack::test
