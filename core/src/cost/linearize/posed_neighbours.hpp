#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "cost/draw/hypothesis_drawer.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A drawn state and the projected vertices of states that differ from it in one parameter each.
class PosedNeighbours {
 public:
  /// Poses with up to `threads` threads. The plan must outlive the object.
  PosedNeighbours(const ScenePlan& plan, int threads);

  /// Sets a frame's cameras, which must outlive the drawing.
  void prepare(const FrameProjection& frame);

  /// Draws states.col(0) and poses the columns 1 + dimensions[i], in parallel in the calling arena,
  /// which has at most `threads` slots. States are normalised.
  void draw(const Eigen::MatrixXd& states, const std::vector<Eigen::Index>& dimensions);

  const HypothesisDrawer& centre() const { return centre_; }
  /// Returns the vertices of every neighbour in a view, kRecord floats each.
  const std::vector<const float*>& records(std::size_t view) const { return beside_[set(view)]; }
  /// Returns, for each kMoverBlock vertices, the neighbours in which any of them has moved.
  const std::vector<int>* movers(std::size_t view) const { return movers_[set(view)].data(); }

 private:
  /// Views of a rectified pair share one set of vertices.
  std::size_t set(std::size_t view) const { return frame_->pair ? 0 : view; }
  void draw_centre();
  void compare(std::size_t set, std::size_t neighbour);
  void list_movers();

  const ScenePlan& plan_;
  const FrameProjection* frame_ = nullptr;
  /// Made and prepared when a thread first needs it.
  struct Poser {
    std::unique_ptr<HypothesisDrawer> drawer;
    bool is_prepared = false;
  };
  HypothesisDrawer& poser_of_thread();

  std::vector<Poser> posers_;  // one per slot of the arena
  HypothesisDrawer centre_;
  std::vector<float> records_;
  // Per set of vertices:
  std::vector<std::vector<const float*>> beside_;
  std::vector<std::vector<std::uint8_t>> differs_;  // per neighbour and block of vertices
  std::vector<std::vector<std::vector<int>>> movers_;
};

}  // namespace internal
}  // namespace hypotrack
