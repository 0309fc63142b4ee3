#include <fmt/format.h>
#include <hwy/aligned_allocator.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "cost/draw/hypothesis_renderer.hpp"
#include "cost/gl/egl_drawer.hpp"
#include "gl/egl_context.hpp"

namespace hypotrack::internal {
namespace {

constexpr int kMostRows = 8192;  // read back at once, unless one hypothesis has more

/// Draws with OpenGL in the thread that calls render(), reads the tiles back and visits them on
/// several threads.
class EglRenderer : public HypothesisRenderer {
 public:
  EglRenderer(const Scene& scene, int threads)
      : drawer_(scene), arena_(threads > 0 ? threads : tbb::info::default_concurrency()) {}

  void prepare(const Observation& observation) override {
    drawer_.prepare(observation);
    cameras_.clear();
    for (const TileView& view : observation.views) cameras_.push_back(view.camera);
  }

  void render(const Eigen::MatrixXd& states, const Visit& visit) override {
    if (cameras_.empty() || states.cols() == 0) return visit_batch(states, 0, states.cols(), visit);
    const Eigen::Index batch = std::min(states.cols(), batch_size());
    reserve(batch);
    for (Eigen::Index first = 0; first < states.cols(); first += batch) {
      const Eigen::Index count = std::min(batch, states.cols() - first);
      drawer_.draw(states.middleCols(first, count), *layers_);
      layers_->read(drawer_.layers_for(count).layers, pixels_.get());
      visit_batch(states, first, count, visit);
    }
  }

  std::string description() const override {
    return fmt::format("egl ({})", drawer_.context().device());
  }

 private:
  Eigen::Index batch_size() const {
    const LayerSize one = drawer_.layers_for(1);
    return std::clamp<Eigen::Index>(kMostRows / (one.height * one.layers), 1,
                                    drawer_.largest_batch());
  }

  void reserve(Eigen::Index batch) {
    const LayerSize size = drawer_.layers_for(batch);
    if (layers_ && layers_->holds(size)) return;
    layers_.reset();
    layers_ = std::make_unique<EglLayers>(drawer_.context(), size);
    pixels_ = hwy::AllocateAligned<float>(static_cast<std::size_t>(size.width) *
                                          static_cast<std::size_t>(size.height) *
                                          static_cast<std::size_t>(size.layers));
  }

  void visit_batch(const Eigen::MatrixXd& states, Eigen::Index first, Eigen::Index count,
                   const Visit& visit) {
    arena_.execute([&] {
      tbb::parallel_for(Eigen::Index{0}, count, [&](Eigen::Index i) {
        const auto tiles = tiles_of(i);
        visit(first + i,
              {{states.col(first + i).data(), static_cast<std::size_t>(states.rows())}, tiles});
      });
    });
  }

  std::vector<DepthTile> tiles_of(Eigen::Index i) const {
    const LayerSize size = drawer_.layers_for(1);
    const float* pixels = pixels_.get() + i * size.layers * size.width * size.height;
    std::vector<DepthTile> tiles;
    for (const TileCamera& camera : cameras_) {
      tiles.push_back(
          {camera.width, camera.height, size.width, pixels, 0, 0, camera.width, camera.height});
      pixels += std::ptrdiff_t{size.width} * size.height;
    }
    return tiles;
  }

  EglDrawer drawer_;
  std::unique_ptr<const EglLayers> layers_;
  hwy::AlignedFreeUniquePtr<float[]> pixels_;
  std::vector<TileCamera> cameras_;
  tbb::task_arena arena_;
};

}  // namespace

std::unique_ptr<HypothesisRenderer> make_egl_renderer(const Scene& scene, int threads) {
  return std::make_unique<EglRenderer>(scene, threads);
}

}  // namespace hypotrack::internal
