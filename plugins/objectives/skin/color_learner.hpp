#pragma once

#include <optional>
#include <vector>

#include "color_model.hpp"
#include "hypotrack/observation.hpp"
#include "settings.hpp"

namespace hypotrack::skin {

/// Learns one view's colours on the first settings.learn_frames frames that show the models: those
/// inside the silhouette of the scene as it is posed in observation.start, against those outside,
/// give or take settings.pose_error (ColorModel::add()). What it learns where the start is a guess
/// (observation.start_is_guess) counts for less. Each guess begins anew, and so does the first
/// observation after one.
class ColorLearner {
 public:
  explicit ColorLearner(const Settings& settings) : settings_(settings) {}

  /// Whether it may have something to learn from this frame (observation.frame): the same frame
  /// again teaches nothing new.
  bool wants(const Observation& observation) const {
    if (from_guess_ || observation.start_is_guess) return true;
    return learned_ < settings_.learn_frames && last_seen_ != observation.frame;
  }
  /// Learns from the view's colours, 8-bit BGR, where `valid` is not 0. Of the observation's images
  /// none is looked at. A frame with less than a tenth of the silhouette in the image teaches
  /// nothing; before any other, every colour is as likely foreground as not.
  void learn(const Observation& observation, const TileCamera& camera, const cv::Mat3b& color,
             const cv::Mat1b& valid);

  /// P of every bin (bin_of()); empty before the first frame.
  const std::vector<float>& probabilities() const { return probabilities_; }

 private:
  Settings settings_;
  ColorModel colors_;
  std::vector<float> probabilities_;
  std::optional<int> last_seen_;
  int learned_ = 0;
  bool from_guess_ = false;
};

}  // namespace hypotrack::skin
