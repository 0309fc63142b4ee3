#pragma once

#include <deque>
#include <functional>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <vector>

#include "hypotrack/plugin/observation.hpp"
#include "match.hpp"

namespace hypotrack::landmarks {

/// What finds hands in a picture: HandDetector, or what stands in for it. Several threads call it
/// at the same time.
struct Detector {
  std::function<std::vector<HandDetection>(const cv::Mat& picture)> detect;
  /// `followed`: the guess is the hand of the last frame, moved, and not a model's.
  std::function<std::optional<HandDetection>(const cv::Mat& picture, const HandPoints& guess,
                                             bool followed)>
      refine;
};

/// A model's hand as points in the world; NaN: the model has no such point.
struct ModelHand {
  HandPoints3D start;                    ///< where the search starts
  std::optional<HandPoints3D> previous;  ///< in FrameContext::previous; nothing without it
  bool right = true;
};

/// Finds the hands of models in tiles. It remembers what it found in the last frames, so that the
/// networks do not look twice at the same part of a picture. Several threads may use it, each for
/// another view.
class HandFinder {
 public:
  explicit HandFinder(Detector detector) : detector_(std::move(detector)) {}

  /// Returns the hand of each model in a view, which has a colour image. It looks first where the
  /// hand of the last frame has moved as the model has since, or else near the model, and then in
  /// all of the tile.
  std::vector<std::optional<SeenHand>> find(const Observation& observation, std::size_t view,
                                            std::span<const ModelHand> models);

  /// Returns whether find() saw a hand of the other side in a view, surely and about where the
  /// model's search starts.
  bool saw_other_side(const Observation& observation, std::size_t view, const ModelHand& model);

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
  /// Returns what was found for each model in the last frame; nothing where that is not known.
  std::vector<std::optional<SeenHand>> last(const Observation& observation, std::size_t view,
                                            std::span<const ModelHand> models);
  /// Looks for a hand near the last one, or else near the model.
  std::optional<HandDetection> look(const TileView& tile, const ModelHand& model,
                                    const std::optional<SeenHand>& last) const;
  /// Adds a detection unless it is of a hand that is known.
  static void add(Seen& seen, const HandDetection& detection, const TileCamera& camera);

  Detector detector_;
  std::mutex mutex_;
  std::deque<Seen> seen_;  ///< guarded by the mutex, but for what a view's thread knows of it
};

}  // namespace hypotrack::landmarks
