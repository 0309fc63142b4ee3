#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// Data that a start may look at.
struct StartContext {
  const Scene& scene;
  const std::vector<Camera>& cameras;  ///< in the order of a frame's views
  const Frame* frame = nullptr;  ///< the frame to search, with views; null before there is one
};

/// Gives the state in which the search of the first frame begins.
class HYPOTRACK_API Start {
 public:
  Start() = default;
  virtual ~Start();
  Start(const Start&) = delete;
  Start& operator=(const Start&) = delete;

  /// Returns a state of the scene with unit quaternions and angles within their bounds. Returns
  /// nothing if it needs a frame and there is none yet; with a frame it returns a state or throws.
  /// Equal contexts give equal states. Throws ConfigError or DataError, which say where it looked
  /// and what it did not find.
  virtual std::optional<Eigen::VectorXd> state(const StartContext& context) = 0;
};

}  // namespace hypotrack
