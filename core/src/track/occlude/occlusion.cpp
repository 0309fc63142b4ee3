#include "track/occlude/occlusion.hpp"

#include <utility>

namespace hypotrack::internal {

Occlusion::Occlusion(const Scene& scene, const std::vector<Camera>& cameras)
    : scene_(scene), cameras_(cameras) {}

void Occlusion::look(const Frame& frame, const Eigen::VectorXd& state, const ColorMap& colors,
                     const PoseVerifier& verifier, const std::vector<bool>& models) {
  constexpr int kAfterwards = 3;  // frames
  if (finders_.empty())
    for (std::size_t m = 0; m < scene_.items().size(); ++m)
      finders_.emplace_back(scene_, m, cameras_);
  frame_ = frame.index;
  HiddenViews found;
  for (std::size_t m = 0; m < models.size(); ++m) {
    if (!models[m] || !verifier.experienced(m)) continue;
    auto parts = finders_[m].find(frame, state, colors, verifier.colors(m));
    for (std::size_t view = 0; parts && view < parts->size(); ++view)
      found.parts[view].push_back(std::move((*parts)[view]));
  }
  if (found.empty()) {
    hidden_.reset();
    if (awaited_ > 0) --awaited_;
    return;
  }
  hidden_ = std::make_shared<const HiddenViews>(std::move(found));
  awaited_ = kAfterwards;
}

}  // namespace hypotrack::internal
