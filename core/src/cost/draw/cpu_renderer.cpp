#include <fmt/format.h>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "cost/draw/hypothesis_drawer.hpp"
#include "cost/draw/hypothesis_renderer.hpp"

namespace hypotrack::internal {
namespace {

class CpuRenderer : public HypothesisRenderer {
 public:
  CpuRenderer(const Scene& scene, bool draws, int threads)
      : threads_(threads > 0 ? threads : tbb::info::default_concurrency()),
        limit_(tbb::global_control::max_allowed_parallelism,
               static_cast<std::size_t>(std::max(threads_, tbb::info::default_concurrency()))),
        arena_(threads_) {
    if (!draws) return;
    plan_ = std::make_unique<ScenePlan>(scene, ScenePlan::Surface::simplified);
    for (int i = 0; i < threads_; ++i) {
      drawers_.push_back(std::make_unique<HypothesisDrawer>(*plan_));
    }
  }

  void prepare(const Observation& observation) override {
    frame_ = FrameProjection(observation);
    for (const auto& drawer : drawers_) drawer->prepare(frame_);
  }

  void render(const Eigen::MatrixXd& states, const Visit& visit) override {
    views_at_once_ = 2 * states.cols() <= threads_;
    arena_.execute([&] {
      tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, states.cols()),
                        [&](const tbb::blocked_range<Eigen::Index>& range) {
                          // A parallel objective must not start another hypothesis while it waits,
                          // because that would overwrite the tiles in use.
                          tbb::this_task_arena::isolate([&] {
                            for (auto i = range.begin(); i < range.end(); ++i) {
                              visit_one(states, i, visit);
                            }
                          });
                        });
    });
  }

  std::string description() const override {
    return fmt::format("cpu ({}, {} thread{})", simd_target(), threads_, threads_ == 1 ? "" : "s");
  }

 private:
  void visit_one(const Eigen::MatrixXd& states, Eigen::Index i, const Visit& visit) {
    const std::span<const double> state(states.col(i).data(),
                                        static_cast<std::size_t>(states.rows()));
    if (drawers_.empty()) return visit(i, {state, {}});
    const int thread = tbb::this_task_arena::current_thread_index();
    HypothesisDrawer& drawer = *drawers_[static_cast<std::size_t>(thread)];
    visit(i, {state, views_at_once_ ? drawer.draw_by_views(state) : drawer.draw(state)});
  }

  int threads_;
  bool views_at_once_ = false;  // few states leave threads without work
  tbb::global_control limit_;   // allows more threads than cores
  tbb::task_arena arena_;
  std::unique_ptr<const ScenePlan> plan_;
  FrameProjection frame_;
  std::vector<std::unique_ptr<HypothesisDrawer>> drawers_;  // one per slot of the arena
};

}  // namespace

std::unique_ptr<HypothesisRenderer> make_cpu_renderer(const Scene& scene, bool draws, int threads) {
  return std::make_unique<CpuRenderer>(scene, draws, threads);
}

}  // namespace hypotrack::internal
