#include "recorded_search.hpp"

#include <fmt/format.h>

#include <fstream>
#include <numbers>
#include <ostream>
#include <utility>
#include <vector>

#include "output/recording/recording_writer.hpp"
#include "test_paths.hpp"
#include "track/search/search_space.hpp"

namespace hypotrack::test {
namespace {

/// The scenes' first camera, and one that has been taken around what is tracked.
std::vector<Camera> turned_apart() {
  Camera camera;
  camera.width = 1280;
  camera.height = 720;
  camera.fx = camera.fy = 700;
  camera.cx = 639.5;
  camera.cy = 359.5;
  std::vector<Camera> cameras(2, camera);
  const Eigen::Vector3d hands(0.05, 0.04, 0.55);
  Eigen::Isometry3d& pose = cameras[1].camera_from_world;
  pose = Eigen::AngleAxisd(40 * std::numbers::pi / 180, Eigen::Vector3d::UnitY());
  pose.translation() = Eigen::Vector3d(0, 0, hands.z()) - pose.linear() * hands;
  return cameras;
}

OpenedScene open(const RecordedCase& c, PluginLoader& plugins) {
  const auto scene = source_dir() / "configs/scenes" / fmt::format("{}.yaml", c.scene);
  std::vector<std::string> overrides{
      "source.depth=true", "optimizer={type: pso, particles: 32, generations: 32}",
      "search={rotation_as: quaternion}", fmt::format("objective={{type: {}}}", c.objective),
      fmt::format("tile.size={}", c.tile)};
  const TemporaryDirectory folder;
  if (c.rig == Rig::general) {
    const auto file = folder.path() / "rig.yaml";
    std::ofstream(file) << calibration_yaml(turned_apart());
    overrides.push_back("source.calibration.file=" + file.string());
  }
  return open_scene(scene, overrides, plugins);
}

/// Hands search points on to an cost and keeps their states and costs.
class Recorder final : public CostFunction {
 public:
  Recorder(const SearchSpace& space, const Eigen::VectorXd& prior, Cost& cost)
      : space_(space), prior_(prior), cost_(cost) {}

  int dimension() const override { return space_.dimension(); }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override {
    const Eigen::MatrixXd batch = space_.states(points, prior_);
    cost_.evaluate(batch, costs);
    recorded_states.conservativeResize(batch.rows(), recorded_states.cols() + batch.cols());
    recorded_states.rightCols(batch.cols()) = batch;
    recorded_costs.conservativeResize(recorded_costs.size() + costs.size());
    recorded_costs.tail(costs.size()) = costs;
  }

  Eigen::MatrixXd recorded_states;
  Eigen::VectorXd recorded_costs;

 private:
  const SearchSpace& space_;
  const Eigen::VectorXd& prior_;
  Cost& cost_;
};

}  // namespace

std::ostream& operator<<(std::ostream& out, const RecordedCase& c) {
  return out << c.scene << '_' << c.objective << '_'
             << (c.rig == Rig::rectified ? "rectified" : "general") << '_' << c.tile;
}

RecordedSearch::RecordedSearch(const RecordedCase& c)
    : session_(open(c, plugins_)),
      tiles_(*session_.scene, session_.parts.cameras, session_.parts.tile),
      frame_(session_.source->next().value()) {
  record();
}

std::unique_ptr<Cost> RecordedSearch::cost_on(Backend backend) const {
  return make_cost(*session_.scene, session_.parts.objective, {.backend = backend});
}

void RecordedSearch::record() {
  const Eigen::VectorXd& truth = frame_.truth.value().state;
  const SearchSpace space(*session_.scene, session_.parts.search);
  const auto cost = cost_on(Backend::cpu);
  cost->prepare(tiles_, frame_, tiles_.plan(frame_, truth));
  Recorder recorder(space, truth, *cost);
  Optimizer& pso = *session_.parts.optimizer;
  pso.minimize(recorder, space.region(truth), {.evaluations = pso.default_evaluations()},
               session_.seed);
  states_ = std::move(recorder.recorded_states);
  costs_ = std::move(recorder.recorded_costs);
}

Eigen::VectorXd RecordedSearch::costs_on(Backend backend) const {
  const auto cost = cost_on(backend);
  cost->prepare(tiles_, frame_, tiles_.plan(frame_, frame_.truth.value().state));
  Eigen::VectorXd costs(states_.cols());
  cost->evaluate(states_, costs);
  return costs;
}

}  // namespace hypotrack::test
