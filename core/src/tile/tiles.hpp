#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "camera/rectification.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "hypotrack/plugin/params.hpp"
#include "scene/posed_scene.hpp"
#include "tile/foreground_overlap.hpp"
#include "tile/resample.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Parameters of a scene's `tile:` section.
struct TileSettings {
  int size = 128;
  double padding = 0.2;
  void visit(ParamVisitor& v) {
    v("size", size, {.help = "pixels along one side of a view's tile", .min = 16, .max = 1024});
    v("padding", padding,
      {.help = "margin around the last solution, each side, as a share of its size",
       .min = 0,
       .max = 2});
  }
};

/// Everything that resampling a frame's tiles needs besides its pixels.
struct TilePlan {
  Observation header;               ///< the observation without images
  std::vector<ResamplePlan> views;  ///< one per view
};

/// Crops the region around a hypothesis from every view of a frame. One resampling step undistorts
/// it, scales it to a square tile and rectifies nearly parallel pairs.
class TileMaker {
 public:
  /// The scene must outlive the tile maker.
  TileMaker(const Scene& scene, std::vector<Camera> cameras, const TileSettings& settings);
  ~TileMaker();
  TileMaker(const TileMaker&) = delete;
  TileMaker& operator=(const TileMaker&) = delete;

  /// Returns true if the pair is parallel enough to be rectified.
  bool rectifies() const;

  /// Returns one resampler per camera.
  std::span<const Resampler> resamplers() const;

  /// Excludes models from tiles and shares from now on: one flag per model, not all set.
  void leave_out(const std::vector<bool>& models);

  /// Returns the share of the models' vertices that every image shows, ignoring occlusion. Returns
  /// 0 if any lies behind a camera, so that no tile exists. Call it from one thread at a time. The
  /// last state's pose is cached, for this function and plan().
  double visible_share(const Eigen::VectorXd& state) const;

  /// Returns where the scene posed in `state` lies in the frame's masks. It is fast if the scene
  /// covers much of the foreground.
  ForegroundOverlap foreground_overlap(const Frame& frame, const Eigen::VectorXd& state) const;

  const Scene& scene() const;
  /// Returns the scene posed in `state`, cached for the last state. Call it from one thread at a
  /// time.
  const PosedScene& posed(const Eigen::VectorXd& state) const;

  /// Plans the tiles around the scene posed in `state`, without reading pixels. Call it from one
  /// thread at a time. Throws DataError if the frame's views do not match the cameras in number or
  /// size, or if the posed scene lies at or behind a camera.
  TilePlan plan(const Frame& frame, const Eigen::VectorXd& state) const;

  /// Resamples the tiles of a frame by its plan.
  Observation resample(const Frame& frame, const TilePlan& plan) const;

  /// Plans and resamples the tiles of a frame.
  Observation make(const Frame& frame, const Eigen::VectorXd& state) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Returns the cameras of size x size pixel tiles around bounds. The margin on each side is
/// `padding` times the larger extent. No tile is wider than `largest_focal` pixels at z = 1. Tiles
/// of a rectified pair share rows and scale.
std::vector<TileCamera> crop(std::span<const Bounds> around, const IdealRig& rig, int size,
                             double padding, double largest_focal);

/// Throws DataError unless a frame has a view per camera, with pictures of its size and of the
/// right types.
void check_views(const Frame& frame, const std::vector<Camera>& cameras);

}  // namespace internal
}  // namespace hypotrack
