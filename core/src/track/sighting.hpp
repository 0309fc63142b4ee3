#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/starter.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Distances, mean over a model's landmarks in metres, up to which a starter sees a model where a
/// pose has it, and beyond which it contradicts the pose.
inline constexpr double kHere = 0.025, kElsewhere = 0.04;

/// Returns the mean distance over a model's landmarks between two poses of it, in metres.
double landmark_distance(const Model& model, std::span<const double> a, std::span<const double> b);

/// Returns the mean of a model's landmarks in a pose.
Eigen::Vector3d landmark_center(const Model& model, const Eigen::VectorXd& pose);

/// Throws PluginError unless a starter proposes a pose of the model.
void check_proposal(const Scene::Item& item, const Eigen::VectorXd& parameters);

/// The poses in which the detectors of a model see it in a frame.
struct Sighting {
  bool asked = false;                       ///< the model has a detector
  std::vector<Eigen::VectorXd> poses = {};  ///< parameters of the model, which is surely there

  /// Returns the distance of a pose of the model from the nearest of them; nothing without any.
  std::optional<double> distance(const Model& model, std::span<const double> pose) const;
};

/// Asks the detectors of a model for its poses, without a search.
Sighting sighting(const std::vector<std::unique_ptr<Starter>>& starters, const Scene& scene,
                  const std::vector<Camera>& cameras, const Frame& frame, std::size_t model);

}  // namespace internal
}  // namespace hypotrack
