#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/api/solution.hpp"

namespace hypotrack {

/// Pictures of all views and the models to draw on them.
struct ShownViews {
  int frame = 0;
  std::vector<cv::Mat> images;  ///< 8-bit BGR, shared with the source's frame
  Eigen::VectorXd state;
  std::vector<bool> hidden;  ///< for each model, true if its pose is unknown
};

/// A tracked frame as viewers get it.
struct LiveFrame {
  Solution solution;
  std::vector<double> sigmas;   ///< by model: mean of its landmarks, metres; NaN: unknown
  double error = std::nan("");  ///< mean distance from the ground truth, metres; NaN: unknown
  double fps = std::nan("");    ///< of the last frames, pauses left out; NaN: unknown
  std::shared_ptr<const ShownViews> views;  ///< of the last usable frame; null: none yet
  std::optional<std::int64_t> stamp{};      ///< Frame::stamp
};

/// What a viewer's user has asked of a run.
struct LiveStatus {
  bool paused = false;
  std::optional<int> recorded = {};  ///< frames so far in the recording, if there is one
  bool operator==(const LiveStatus&) const = default;
};

/// Returns the views of a usable frame with its solution.
ShownViews shown_views(const Frame& frame, const Solution& solution);

/// Returns the mean sigma of each model's landmarks, in metres; NaN where it is unknown.
std::vector<double> model_sigmas(const Scene& scene, const Solution& solution);

}  // namespace hypotrack
