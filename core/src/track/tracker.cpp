#include "track/tracker.hpp"

#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace hypotrack {
namespace {

/// Costs of search points: points become states, states are evaluated.
class StateCost final : public CostFunction {
 public:
  StateCost(const SearchSpace& space, const Eigen::VectorXd& prior, Evaluator& evaluator)
      : space_(space), prior_(prior), evaluator_(evaluator) {}

  int dimension() const override { return space_.dimension(); }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override {
    evaluator_.evaluate(space_.states(points, prior_), costs);
  }
  cuda::DeviceCost* device() override {
    return evaluator_.device_cost(prior_, space_.rotation_vectors());
  }

 private:
  const SearchSpace& space_;
  const Eigen::VectorXd& prior_;
  Evaluator& evaluator_;
};

/// A seed of its own for every frame (splitmix64 of both numbers), so that a frame's search does
/// not depend on how many random numbers the frames before it used.
std::uint64_t frame_seed(std::uint64_t seed, int frame) {
  std::uint64_t z = seed + 0x9e3779b97f4a7c15ULL * (static_cast<std::uint64_t>(frame) + 1);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

}  // namespace

Tracker::Tracker(const Scene& scene, TrackerParts parts, Eigen::VectorXd start, std::uint64_t seed)
    : parts_(std::move(parts)),
      tiles_(scene, parts_.cameras, parts_.tile),
      visible_(scene, parts_.cameras),
      space_(scene, parts_.search),
      evaluator_(scene, parts_.objective, parts_.evaluate),
      monitor_(parts_.status),
      state_(std::move(start)),
      seed_(seed) {
  scene.normalize(state_);
  if (parts_.budget.evaluations == 0)
    parts_.budget.evaluations = parts_.optimizer->default_evaluations();
}

Tracker::~Tracker() = default;

Solution Tracker::track(const Frame& frame) {
  Solution solution;
  solution.frame = frame.index;
  solution.time = frame.time;
  solution.cost = std::numeric_limits<double>::quiet_NaN();
  if (!frame.views.empty()) {
    const auto begin = std::chrono::steady_clock::now();
    const Eigen::VectorXd prior = state_;
    const OptimizerResult result = search(frame, prior);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    const Eigen::VectorXd found = space_.states(result.point, prior);
    const double visible = visible_.of(found);
    // Where nothing was feasible, or the answer has left every image, the last state is the better
    // place to search the next frame from.
    if (std::isfinite(result.cost) && visible > 0) state_ = found;
    solution.seconds = elapsed.count();
    solution.cost = result.cost;
    solution.evaluations = result.evaluations;
    solution.status = monitor_.judge(result.cost, visible);
  }
  solution.state = state_;
  return solution;
}

void Tracker::check(const Frame& frame) {
  evaluator_.prepare(tiles_, frame, tiles_.plan(frame, state_));
}

OptimizerResult Tracker::search(const Frame& frame, const Eigen::VectorXd& prior) {
  evaluator_.prepare(tiles_, frame, tiles_.plan(frame, prior));
  StateCost cost(space_, prior, evaluator_);
  return parts_.optimizer->minimize(cost, space_.region(prior), parts_.budget,
                                    frame_seed(seed_, frame.index));
}

}  // namespace hypotrack
