#pragma once

#include <deque>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <vector>

#include "hypotrack/observation.hpp"
#include "match.hpp"

namespace hypotrack::landmarks {

/// What finds hands in a picture: HandDetector, or what stands in for it.
struct Detector {
  std::function<std::vector<HandDetection>(const cv::Mat& picture)> detect;
  std::function<std::optional<HandDetection>(const cv::Mat& picture, const HandPoints& guess)>
      refine;
};

/// Finds the hands of models in tiles. It remembers what it found in the last frames, so that the
/// networks do not look twice at the same part of a picture.
class HandFinder {
 public:
  explicit HandFinder(Detector detector) : detector_(std::move(detector)) {}

  /// Returns the hand of each model in a view, which has a colour image. It looks near `starts`
  /// first, the models' points in the world, and then in all of the tile.
  std::vector<std::optional<SeenHand>> find(const Observation& observation, std::size_t view,
                                            std::span<const WantedHand> wanted,
                                            std::span<const HandPoints3D> starts);

 private:
  /// A part of a picture in which hands were looked for.
  struct Part {
    Eigen::Vector3d center;  ///< unit vector along the world's axes
    double side;             ///< radians
  };
  /// What is known of one view of one frame.
  struct Seen {
    int frame;
    double time;
    std::size_t view;
    std::vector<SeenHand> hands = {};
    std::vector<Part> searched = {};
  };

  static Part part_of(const TileCamera& camera);
  static bool searched(const Seen& seen, const Part& part);
  Seen& known(const Observation& observation, std::size_t view);
  /// Adds a detection unless it is of a hand that is known.
  static void add(Seen& seen, const HandDetection& detection, const TileCamera& camera);

  Detector detector_;
  std::deque<Seen> seen_;
};

}  // namespace hypotrack::landmarks
