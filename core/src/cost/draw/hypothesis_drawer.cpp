#include "cost/draw/hypothesis_drawer.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace hypotrack::internal {
namespace {

AlignedFloats zeros(std::size_t count) {
  auto floats = hwy::AllocateAligned<float>(count);
  std::fill_n(floats.get(), count, 0.0f);
  return floats;
}

ViewProjection make_view(const TileCamera& camera, const Eigen::Isometry3d& first_from_world) {
  const Eigen::Isometry3d camera_from_first = camera.camera_from_world * first_from_world.inverse();
  ViewProjection view{};
  Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>> matrix(view.camera_from_first);
  matrix = camera_from_first.matrix().topRows<3>().cast<float>();
  view.fx = static_cast<float>(camera.fx);
  view.fy = static_cast<float>(camera.fy);
  view.cx = static_cast<float>(camera.cx);
  view.cy = static_cast<float>(camera.cy);
  view.width = camera.width;
  view.height = camera.height;
  view.stride = (camera.width + kBlock - 1) / kBlock * kBlock;
  return view;
}

// Returns true if the observation claims that two views share y and 1/z, and the cameras agree.
bool share_rows(const Observation& observation) {
  if (!observation.rectified || observation.views.size() != 2) return false;
  const TileCamera& a = observation.views[0].camera;
  const TileCamera& b = observation.views[1].camera;
  constexpr double kExact = 1e-7;
  Eigen::Isometry3d b_from_a = b.camera_from_world * a.camera_from_world.inverse();
  b_from_a.translation().x() = 0;
  return b_from_a.matrix().isIdentity(kExact) && a.fx == b.fx && a.fy == b.fy && a.cy == b.cy &&
         a.height == b.height;
}

}  // namespace

FrameProjection::FrameProjection(const Observation& observation) : pair(share_rows(observation)) {
  if (observation.views.empty()) return;
  first_from_world = observation.views[0].camera.camera_from_world;
  for (const TileView& view : observation.views) {
    views.push_back(make_view(view.camera, first_from_world));
  }
}

HypothesisDrawer::HypothesisDrawer(const ScenePlan& plan) : plan_(&plan), poser_(plan) {}

void HypothesisDrawer::prepare(const FrameProjection& frame) {
  frame_ = &frame;
  const std::size_t views = frame.views.size();
  const std::size_t list = plan_->triangle_count + std::size_t{kBlock};
  list_storage_.resize(views * kSizeClasses * list);
  visible_.resize(views);
  records_.resize(frame.pair ? 1 : views);
  for (AlignedFloats& records : records_) {
    if (!records) records = zeros(std::size_t{plan_->vertex_count} * kRecord);
  }
  tile_storage_.resize(views);
  tile_size_.resize(views, 0);
  tiles_.assign(views, DepthTile{});
  for (std::size_t i = 0; i < views; ++i) {
    const ViewProjection& view = frame.views[i];
    const std::size_t size =
        static_cast<std::size_t>(view.stride) * static_cast<std::size_t>(view.height);
    if (tile_size_[i] < size) {
      tile_storage_[i] = hwy::AllocateAligned<float>(size);
      tile_size_[i] = size;
    }
    // The tile size may have changed, so the last box does not tell what to clear.
    std::fill_n(tile_storage_[i].get(), size, 0.0f);
    tiles_[i] = {view.width, view.height, view.stride, tile_storage_[i].get(), 0, 0, 0, 0};
  }
}

std::span<const DepthTile> HypothesisDrawer::draw(std::span<const double> state) {
  clear();
  pose(state);
  project();
  cull();
  fill();
  return tiles_;
}

std::span<const DepthTile> HypothesisDrawer::draw_by_views(std::span<const double> state) {
  clear();
  pose(state);
  project();
  if (frame_->pair) cull_view(0);
  tbb::parallel_for(std::size_t{0}, frame_->views.size(), [&](std::size_t view) {
    if (!frame_->pair) cull_view(view);
    fill(view);
  });
  return tiles_;
}

void HypothesisDrawer::clear() {
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    DepthTile& tile = tiles_[i];
    clear_pixels(tile_storage_[i].get(), tile.stride, tile.x0, tile.y0, tile.x1, tile.y1);
    tile.x0 = tile.y0 = tile.x1 = tile.y1 = 0;
  }
}

void HypothesisDrawer::pose(std::span<const double> state) {
  poser_.pose(state, frame_->first_from_world);
}

void HypothesisDrawer::project() {
  if (frame_->pair) {
    PixelRange ranges[2];
    project_pair(poser_.x(), poser_.y(), poser_.z(), plan_->vertex_count, frame_->views.data(),
                 records_[0].get(), ranges);
    set_bounds(0, ranges[0]);
    set_bounds(1, ranges[1]);
    return;
  }
  for (std::size_t i = 0; i < frame_->views.size(); ++i) {
    PixelRange range;
    project_view(poser_.x(), poser_.y(), poser_.z(), plan_->vertex_count, frame_->views[i],
                 records_[i].get(), range);
    set_bounds(i, range);
  }
}

void HypothesisDrawer::set_bounds(std::size_t view, const PixelRange& range) {
  DepthTile& tile = tiles_[view];
  const auto first = [](float low, int size) {
    return static_cast<int>(std::clamp(std::ceil(low), 0.0f, static_cast<float>(size)));
  };
  const auto end = [](float high, int size) {
    return static_cast<int>(std::clamp(std::floor(high) + 1, 0.0f, static_cast<float>(size)));
  };
  tile.x0 = first(range.low_x, tile.width);
  tile.x1 = end(range.high_x, tile.width);
  tile.y0 = first(range.low_y, tile.height);
  tile.y1 = end(range.high_y, tile.height);
  if (tile.x0 >= tile.x1 || tile.y0 >= tile.y1) tile.x0 = tile.x1 = tile.y0 = tile.y1 = 0;
}

VisibleTriangles HypothesisDrawer::empty_lists(std::size_t view) {
  const std::size_t size = plan_->triangle_count + std::size_t{kBlock};
  VisibleTriangles lists;
  for (std::size_t i = 0; i < kSizeClasses; ++i) {
    lists.list[i] = list_storage_.data() + (view * kSizeClasses + i) * size;
  }
  return lists;
}

void HypothesisDrawer::cull_view(std::size_t view) {
  visible_[view] = empty_lists(view);
  if (frame_->pair) visible_[view + 1] = empty_lists(view + 1);
  for (const TriangleRange& range : plan_->ranges) {
    cull_triangles(plan_->corners.data(), range, records_[view].get(), &frame_->views[view],
                   frame_->pair, &visible_[view]);
  }
}

void HypothesisDrawer::cull() {
  if (frame_->pair) {
    cull_view(0);
  } else {
    for (std::size_t i = 0; i < frame_->views.size(); ++i) cull_view(i);
  }
}

void HypothesisDrawer::fill() {
  for (std::size_t i = 0; i < frame_->views.size(); ++i) fill(i);
}

void HypothesisDrawer::fill(std::size_t view) {
  const bool second = frame_->pair && view == 1;
  draw_triangles(plan_->corners.data(), plan_->triangle_count - 1, records(view), second,
                 frame_->views[view], visible_[view], tile_storage_[view].get());
}

}  // namespace hypotrack::internal
