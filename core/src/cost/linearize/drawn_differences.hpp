#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "cost/draw/hypothesis_drawer.hpp"
#include "cost/linearize/difference_blocks.hpp"
#include "cost/term_residuals.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Normal equations of terms that need rendering and offer nothing but residuals: draws a state and
/// all its neighbours.
class DrawnDifferences {
 public:
  /// The plan must outlive it. It is called in an arena of at most `threads` slots.
  DrawnDifferences(const ScenePlan& plan, std::vector<ObjectiveTerm> terms, int threads);

  /// Sets a frame's cameras, which must outlive the drawing. The terms are prepared for that frame.
  void prepare(const FrameProjection& frame);

  /// Adds the normal equations at states.col(0), as ResidualCost::linearize() does. States are
  /// normalised. A neighbour of infinite cost is left out.
  void add(const Eigen::MatrixXd& states, const Eigen::VectorXd& steps, NormalEquations& sums);

 private:
  /// Draws a state, writes the residuals of all terms and returns their cost.
  double write(const Eigen::MatrixXd& states, Eigen::Index column, std::vector<float>& residuals);

  /// A thread's memory, made and prepared when the thread first needs it.
  struct Slot {
    std::unique_ptr<HypothesisDrawer> drawer;
    bool is_prepared = false;
    std::vector<float> residuals;
  };

  const ScenePlan& plan_;
  std::vector<ObjectiveTerm> terms_;
  TermResiduals residuals_;
  const FrameProjection* frame_ = nullptr;
  std::vector<Slot> slots_;  // of the arena
  std::vector<float> here_;
  DifferenceBlocks blocks_;
};

}  // namespace internal
}  // namespace hypotrack
