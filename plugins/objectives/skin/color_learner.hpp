#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "color_model.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "settings.hpp"

namespace hypotrack::skin {

/// Draws the silhouette of a scene in a state into a tile: 255 inside, 0 outside.
cv::Mat1b silhouette(const Scene& scene, const Eigen::VectorXd& state, const TileCamera& camera);

/// Learns one view's foreground colours from the first settings.learn_frames frames that show the
/// models. Compares colours inside the silhouette of the scene, posed in observation.start, with
/// those outside, allowing for settings.pose_error (ColorModel::add()). Frames whose start is a
/// guess (observation.context.start_is_guess) count less. Each guess restarts the learning, and so
/// does the first observation after one.
class ColorLearner {
 public:
  explicit ColorLearner(const Settings& settings) : settings_(settings) {}

  /// Returns whether this frame (observation.frame) may teach something. The same frame again does
  /// not.
  bool wants(const Observation& observation) const {
    if (from_guess_ || observation.context.start_is_guess) return true;
    return learned_ < settings_.learn_frames && last_seen_ != observation.frame;
  }
  /// Learns from the view's colours, 8-bit BGR, where `valid` is not 0. Does not use the
  /// observation's images. A frame with less than a tenth of the silhouette in the image teaches
  /// nothing; if it is the first, every colour gets P = 0.5.
  void learn(const Observation& observation, const TileCamera& camera, const cv::Mat3b& color,
             const cv::Mat1b& valid);

  /// Returns P of every bin (bin_of()); empty before the first frame.
  const std::vector<float>& probabilities() const { return probabilities_; }
  /// Returns the frequencies of every bin's colour, if the cameras are still; otherwise empty.
  const std::vector<ColorFrequency>& frequencies() const { return frequencies_; }

 private:
  Settings settings_;
  ColorModel colors_;
  std::vector<float> probabilities_;
  std::vector<ColorFrequency> frequencies_;
  std::optional<int> last_seen_;
  int learned_ = 0;
  bool from_guess_ = false;
};

}  // namespace hypotrack::skin
