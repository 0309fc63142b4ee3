#include "cost/linearize/posed_neighbours.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cstring>

#include "cost/linearize/pixel_rows.hpp"

namespace hypotrack::internal {
namespace {

std::size_t block_count(const ScenePlan& plan) {
  return (std::size_t{plan.vertex_count} + kMoverBlock - 1) / kMoverBlock;
}

}  // namespace

PosedNeighbours::PosedNeighbours(const ScenePlan& plan, int threads)
    : plan_(plan), posers_(static_cast<std::size_t>(threads)), centre_(plan) {}

void PosedNeighbours::prepare(const FrameProjection& frame) {
  frame_ = &frame;
  centre_.prepare(frame);
  for (Poser& poser : posers_) poser.is_prepared = false;
}

HypothesisDrawer& PosedNeighbours::poser_of_thread() {
  const int slot = tbb::this_task_arena::current_thread_index();
  Poser& own = posers_[static_cast<std::size_t>(slot)];
  if (!own.drawer) own.drawer = std::make_unique<HypothesisDrawer>(plan_);
  if (!own.is_prepared) own.drawer->prepare(*frame_);
  own.is_prepared = true;
  return *own.drawer;
}

void PosedNeighbours::draw(const Eigen::MatrixXd& states,
                           const std::vector<Eigen::Index>& dimensions) {
  const std::size_t sets = frame_->pair ? 1 : frame_->views.size(), count = dimensions.size();
  const std::size_t size = std::size_t{plan_.vertex_count} * kRecord;
  records_.resize(sets * count * size);
  beside_.assign(sets, std::vector<const float*>(count));
  differs_.assign(sets, std::vector<std::uint8_t>(count * block_count(plan_)));
  const auto state = [&](Eigen::Index column) {
    return std::span<const double>(states.col(column).data(),
                                   static_cast<std::size_t>(states.rows()));
  };
  centre_.clear();
  centre_.pose(state(0));
  centre_.project();
  tbb::parallel_for(std::size_t{0}, count + 1, [&](std::size_t i) {
    if (i == 0) return draw_centre();  // first, because it takes longest
    const std::size_t n = i - 1;
    HypothesisDrawer& poser = poser_of_thread();
    poser.pose(state(1 + dimensions[n]));
    poser.project();
    for (std::size_t s = 0; s < sets; ++s) {
      float* own = records_.data() + (s * count + n) * size;
      std::copy_n(poser.records(s), size, own);
      beside_[s][n] = own;
      compare(s, n);
    }
  });
  list_movers();
}

void PosedNeighbours::draw_centre() {
  centre_.cull();
  tbb::parallel_for(std::size_t{0}, frame_->views.size(),
                    [&](std::size_t view) { centre_.fill(view); });
}

void PosedNeighbours::compare(std::size_t set, std::size_t neighbour) {
  const std::size_t blocks = block_count(plan_);
  const float *here = centre_.records(set), *there = beside_[set][neighbour];
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t first = b * kMoverBlock;
    const std::size_t vertices = std::min(kMoverBlock, plan_.vertex_count - first);
    differs_[set][neighbour * blocks + b] =
        std::memcmp(there + first * kRecord, here + first * kRecord,
                    vertices * kRecord * sizeof(float)) != 0;
  }
}

void PosedNeighbours::list_movers() {
  const std::size_t blocks = block_count(plan_);
  movers_.resize(differs_.size());
  for (std::size_t set = 0; set < differs_.size(); ++set) {
    movers_[set].resize(blocks);
    for (std::vector<int>& list : movers_[set]) list.clear();
    for (std::size_t i = 0; i < differs_[set].size(); ++i) {
      if (differs_[set][i]) movers_[set][i % blocks].push_back(static_cast<int>(i / blocks));
    }
  }
}

}  // namespace hypotrack::internal
