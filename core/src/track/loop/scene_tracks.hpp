#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/scene.hpp"
#include "track/loop/departure.hpp"
#include "track/loop/model_track.hpp"
#include "track/status.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The tracks of a scene's models.
class SceneTracks {
 public:
  /// `start` is a state of the scene; `is_given`: the models are expected there. The scene must
  /// outlive the tracks.
  SceneTracks(const Scene& scene, const std::vector<Camera>& cameras, const Eigen::VectorXd& start,
              bool is_given, const StatusSettings& settings);

  std::size_t size() const { return tracks_.size(); }
  ModelTrack& operator[](std::size_t model) { return tracks_[model]; }
  const ModelTrack& operator[](std::size_t model) const { return tracks_[model]; }
  auto begin() { return tracks_.begin(); }
  auto end() { return tracks_.end(); }

  /// Returns the state in which every model has its last right pose.
  Eigen::VectorXd kept() const;
  /// Returns the last state in which all models were right at once; at first, the start.
  const Eigen::VectorXd& together() const { return together_; }
  /// Takes the result of a frame (ModelTrack::take()). `right` flags the models.
  void take(const std::vector<bool>& right, const Eigen::VectorXd& state,
            const Eigen::VectorXd& velocity, double time);

  /// Tells whether models without a pose have left the pictures.
  Departure& departure() { return departure_; }
  /// Begins searches anew for all models.
  void restart();

 private:
  std::vector<ModelTrack> tracks_;
  Eigen::VectorXd together_;
  Departure departure_;
};

}  // namespace internal
}  // namespace hypotrack
