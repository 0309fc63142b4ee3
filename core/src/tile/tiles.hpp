#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/observation.hpp"
#include "hypotrack/params.hpp"
#include "hypotrack/scene.hpp"
#include "scene/posed_scene.hpp"
#include "tile/on_foreground.hpp"
#include "tile/resample.hpp"

namespace hypotrack {

/// `tile:` of a scene.
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

/// What cutting the tiles of a frame needs.
struct TilePlan {
  Observation header;         ///< everything but the pixels: its images are empty
  std::vector<CutPlan> cuts;  ///< one per view
};

/// Cuts the piece around a hypothesis out of every view of a frame: undistorted, scaled to a square
/// tile and, where two cameras are nearly parallel, rectified, all in one resampling.
class HYPOTRACK_API TileMaker {
 public:
  /// The scene must outlive the tile maker.
  TileMaker(const Scene& scene, std::vector<Camera> cameras, const TileSettings& settings);
  ~TileMaker();
  TileMaker(const TileMaker&) = delete;
  TileMaker& operator=(const TileMaker&) = delete;

  /// Whether the pair is near enough to parallel to be rectified.
  bool rectifies() const;

  /// One per camera.
  std::span<const Resampler> resamplers() const;

  /// Leaves models out of tiles and shares from now on: one flag per model, not all set.
  void leave_out(const std::vector<bool>& models);

  /// How much of the scene posed in `state` the cameras see, whatever hides it: the share of the
  /// models' vertices that every image shows; 0 if any lies behind a camera, so that no tile can be
  /// cut. Not from several threads at once. This and plan() cost next to nothing for the state that
  /// either was asked about last.
  double visible_share(const Eigen::VectorXd& state) const;

  /// Where the scene posed in `state` lies in the frame's masks; next to nothing where it covers
  /// much of their foreground.
  OnForeground on_foreground(const Frame& frame, const Eigen::VectorXd& state) const;

  /// The scene posed in `state`. The same cost, and the same thread.
  const PosedScene& posed(const Eigen::VectorXd& state) const;

  /// Where the tiles around the scene posed in `state` lie; looks at no pixel. Throws DataError if
  /// the frame's views do not match the cameras in number or size, or if the posed scene lies at or
  /// behind a camera. Not from several threads at once.
  TilePlan plan(const Frame& frame, const Eigen::VectorXd& state) const;

  /// The tiles of a frame and its plan.
  Observation cut(const Frame& frame, const TilePlan& plan) const;

  /// Both in one.
  Observation make(const Frame& frame, const Eigen::VectorXd& state) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
