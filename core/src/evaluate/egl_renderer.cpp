#include <fmt/format.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "evaluate/egl_drawer.hpp"
#include "evaluate/hypothesis_renderer.hpp"

namespace hypotrack {
namespace {

/// Draws with OpenGL in the thread that calls render(), whichever it is, and hands the tiles on
/// over several threads.
class EglRenderer : public HypothesisRenderer {
 public:
  EglRenderer(const Scene& scene, int threads)
      : drawer_(scene), arena_(threads > 0 ? threads : tbb::info::default_concurrency()) {}

  void prepare(const Observation& observation) override { drawer_.prepare(observation); }

  void render(const Eigen::MatrixXd& states, const Visit& visit) override {
    if (drawer_.views() == 0) return visit_batch(states, 0, states.cols(), visit);
    for (Eigen::Index first = 0; first < states.cols(); first += drawer_.batch_size()) {
      const Eigen::Index count = std::min(drawer_.batch_size(), states.cols() - first);
      drawer_.draw(states, first, count);
      visit_batch(states, first, count, visit);
    }
  }

  std::string description() const override { return fmt::format("egl ({})", drawer_.device()); }

 private:
  void visit_batch(const Eigen::MatrixXd& states, Eigen::Index first, Eigen::Index count,
                   const Visit& visit) {
    arena_.execute([&] {
      tbb::parallel_for(Eigen::Index{0}, count, [&](Eigen::Index i) {
        std::vector<DepthTile> tiles;
        for (int v = 0; v < drawer_.views(); ++v) tiles.push_back(drawer_.tile(i, v));
        visit(first + i,
              {{states.col(first + i).data(), static_cast<std::size_t>(states.rows())}, tiles});
      });
    });
  }

  EglDrawer drawer_;
  tbb::task_arena arena_;
};

}  // namespace

std::unique_ptr<HypothesisRenderer> make_egl_renderer(const Scene& scene, int threads) {
  return std::make_unique<EglRenderer>(scene, threads);
}

}  // namespace hypotrack
