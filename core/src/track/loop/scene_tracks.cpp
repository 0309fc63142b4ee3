#include "track/loop/scene_tracks.hpp"

#include <algorithm>

namespace hypotrack::internal {

SceneTracks::SceneTracks(const Scene& scene, const std::vector<Camera>& cameras,
                         const Eigen::VectorXd& start, bool is_given,
                         const StatusSettings& settings)
    : together_(start), departure_(scene, cameras) {
  Eigen::Index landmarks = 0;
  for (std::size_t m = 0; m < scene.items().size(); ++m) {
    tracks_.emplace_back(scene, m, landmarks, start, is_given, settings);
    landmarks += std::ssize(scene.items()[m].model->data().landmarks);
  }
}

Eigen::VectorXd SceneTracks::kept() const {
  Eigen::VectorXd out = together_;
  for (const ModelTrack& track : tracks_) track.write_kept(out);
  return out;
}

void SceneTracks::take(const std::vector<bool>& right, const Eigen::VectorXd& state,
                       const Eigen::VectorXd& velocity, double time) {
  for (std::size_t m = 0; m < tracks_.size(); ++m) tracks_[m].take(right[m], state, velocity, time);
  if (std::ranges::find(right, false) == right.end()) together_ = kept();
}

void SceneTracks::restart() {
  for (ModelTrack& track : tracks_) track.restart();
  departure_.forget();
}

}  // namespace hypotrack::internal
