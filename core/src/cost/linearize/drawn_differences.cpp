#include "cost/linearize/drawn_differences.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <cmath>
#include <utility>

namespace hypotrack::internal {

DrawnDifferences::DrawnDifferences(const ScenePlan& plan, std::vector<ObjectiveTerm> terms,
                                   int threads)
    : plan_(plan),
      terms_(std::move(terms)),
      residuals_(terms_),
      slots_(static_cast<std::size_t>(threads)) {}

void DrawnDifferences::prepare(const FrameProjection& frame) {
  frame_ = &frame;
  residuals_.prepare();
  for (Slot& slot : slots_) slot.is_prepared = false;
}

double DrawnDifferences::write(const Eigen::MatrixXd& states, Eigen::Index column,
                               std::vector<float>& residuals) {
  Slot& own = slots_[static_cast<std::size_t>(tbb::this_task_arena::current_thread_index())];
  if (!own.drawer) own.drawer = std::make_unique<HypothesisDrawer>(plan_);
  if (!own.is_prepared) own.drawer->prepare(*frame_);
  own.is_prepared = true;
  residuals.resize(static_cast<std::size_t>(residuals_.count()));
  const std::span<const double> state(states.col(column).data(),
                                      static_cast<std::size_t>(states.rows()));
  const RenderedHypothesis hypothesis{state, own.drawer->draw(state)};
  double cost = 0;
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    cost += terms_[t].weight * residuals_.write(t, hypothesis, residuals);
  }
  return cost;
}

void DrawnDifferences::add(const Eigen::MatrixXd& states, const Eigen::VectorXd& steps,
                           NormalEquations& sums) {
  if (terms_.empty() || residuals_.count() == 0) return;
  // A thread that waits within a term must not begin another state: its drawer is in use.
  tbb::this_task_arena::isolate([&] { write(states, 0, here_); });
  blocks_.begin(here_, steps.size());
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(steps.size());
  tbb::parallel_for(Eigen::Index{0}, steps.size(), [&](Eigen::Index i) {
    if (steps[i] == 0) return;
    std::vector<float>& own =
        slots_[static_cast<std::size_t>(tbb::this_task_arena::current_thread_index())].residuals;
    double cost = 0;
    tbb::this_task_arena::isolate([&] { cost = write(states, i + 1, own); });
    if (!std::isfinite(cost)) return;
    blocks_.set(i, own);
    scale[i] = 1 / steps[i];
  });
  const NormalEquations found = blocks_.normal_equations(scale);
  sums.a += found.a;
  sums.g += found.g;
}

}  // namespace hypotrack::internal
