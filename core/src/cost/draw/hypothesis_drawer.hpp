#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "cost/draw/raster_kernels.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "scene/scene_plan.hpp"
#include "scene/scene_poser.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The cameras of a frame's tiles, in the kernels' form.
struct FrameProjection {
  FrameProjection() = default;
  explicit FrameProjection(const Observation& observation);

  Eigen::Isometry3d first_from_world = Eigen::Isometry3d::Identity();
  std::vector<ViewProjection> views;
  bool pair = false;  ///< the views share y and 1/z
};

/// Poses and draws one hypothesis at a time into its own tiles; one per thread. draw() runs the
/// stages in their order. They are public so that each can be measured.
class HypothesisDrawer {
 public:
  /// The plan must outlive the drawer.
  explicit HypothesisDrawer(const ScenePlan& plan);

  /// Sets a frame's cameras, which must outlive the drawing.
  void prepare(const FrameProjection& frame);

  /// Draws a normalised state; returns its depth in every view, valid until the next call.
  std::span<const DepthTile> draw(std::span<const double> state);
  /// Draws as draw() does, the views at the same time: for states too few to occupy all threads.
  std::span<const DepthTile> draw_by_views(std::span<const double> state);

  std::span<const DepthTile> tiles() const { return tiles_; }
  /// Returns the posed state's projected vertices in a view (kRecord floats each). Both views of a
  /// rectified pair share their records.
  const float* records(std::size_t view) const { return records_[frame_->pair ? 0 : view].get(); }
  const VisibleTriangles& visible(std::size_t view) const { return visible_[view]; }
  void clear();                              ///< clears the previous drawing
  void pose(std::span<const double> state);  ///< kinematics and skinning
  void project();
  void cull();
  void fill();
  void fill(std::size_t view);  ///< may run for several views at once

 private:
  void set_bounds(std::size_t view, const PixelRange& range);
  VisibleTriangles empty_lists(std::size_t view);
  void cull_view(std::size_t view);

  const ScenePlan* plan_;
  const FrameProjection* frame_ = nullptr;
  ScenePoser poser_;
  std::vector<AlignedFloats> records_;  // one per view, or one for a rectified pair
  std::vector<std::uint32_t> list_storage_;
  std::vector<VisibleTriangles> visible_;
  std::vector<AlignedFloats> tile_storage_;
  std::vector<std::size_t> tile_size_;
  std::vector<DepthTile> tiles_;
};

}  // namespace internal
}  // namespace hypotrack
