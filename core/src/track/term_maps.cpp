#include <algorithm>

#include "cost/draw/hypothesis_renderer.hpp"
#include "track/loop/frame_record.hpp"

namespace hypotrack::internal {
namespace {

/// Returns z in metres of a drawn tile; 0 where nothing is drawn.
cv::Mat depth_of(const DepthTile& tile) {
  cv::Mat1f depth(tile.height, tile.width, 0.0f);
  for (int y = 0; y < tile.height; ++y) {
    const float* row = tile.inverse_depth + static_cast<std::ptrdiff_t>(y) * tile.stride;
    std::transform(row, row + tile.width, depth[y],
                   [](float inverse) { return inverse > 0 ? 1 / inverse : 0.0f; });
  }
  return depth;
}

}  // namespace

void draw_maps(const Scene& scene, const std::vector<ObjectiveTerm>& terms, SearchRecord& record) {
  const auto renderer = make_cpu_renderer(scene, true, 1);
  renderer->prepare(record.observation);
  Eigen::MatrixXd state = record.state;
  scene.normalize(state.col(0));
  renderer->render(state, [&](Eigen::Index, const RenderedHypothesis& hypothesis) {
    for (const DepthTile& tile : hypothesis.views) record.depth.push_back(depth_of(tile));
    for (const ObjectiveTerm& term : terms) {
      if (term.weight == 0 || !term.objective->has_maps()) continue;
      term.objective->prepare(record.observation);
      for (PixelMap& map : term.objective->maps(hypothesis))
        record.maps.push_back({term.name, std::move(map)});
    }
  });
}

}  // namespace hypotrack::internal
