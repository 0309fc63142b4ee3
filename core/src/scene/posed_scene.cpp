#include "scene/posed_scene.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

constexpr float kNearest = 1e-3f;  // least distance in front of every camera, metres

void extend(Bounds& bounds, const PlaneBounds& part) {
  bounds.x0 = std::min(bounds.x0, part.x0);
  bounds.x1 = std::max(bounds.x1, part.x1);
  bounds.y0 = std::min(bounds.y0, part.y0);
  bounds.y1 = std::max(bounds.y1, part.y1);
}

}  // namespace

PosedScene::PosedScene(const Scene& scene, const IdealRig& rig)
    : scene_(scene),
      plan_(scene),
      poser_(plan_),
      first_from_world_(rig.ideal_from_world.at(0)),
      left_out_(plan_.parts.size(), false) {
  for (const Eigen::Isometry3d& ideal_from_world : rig.ideal_from_world) {
    const Eigen::Isometry3d ideal_from_first = ideal_from_world * first_from_world_.inverse();
    Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(
        ideal_from_first_.emplace_back().data()) =
        ideal_from_first.matrix().topRows<3>().cast<float>();
  }
}

void PosedScene::pose(const Eigen::VectorXd& state) {
  if (posed_ && state == given_) return;
  posed_ = false;
  given_ = state;
  normal_ = state;
  scene_.normalize(normal_);
  poser_.pose({normal_.data(), static_cast<std::size_t>(normal_.size())}, first_from_world_);
  find_bounds();
  posed_ = true;
}

void PosedScene::leave_out(const std::vector<bool>& models) {
  if (models == left_out_) return;
  left_out_ = models;
  posed_ = false;
}

void PosedScene::find_bounds() {
  behind_ = {};
  bounds_.assign(ideal_from_first_.size(), {});
  for (const ScenePlan::Part& part : plan_.parts) {
    if (leaves_out(part)) continue;
    const std::size_t first = part.first_vertex;
    const std::size_t blocks = (std::size_t{part.vertex_count} + kBlock - 1) / kBlock;
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      PlaneBounds bounds{};
      bound_points(poser_.x() + first, poser_.y() + first, poser_.z() + first, blocks * kBlock,
                   ideal_from_first_[i].data(), bounds);
      if (!(bounds.nearest >= kNearest)) {
        behind_ = {&part, i, bounds.nearest};
        return;
      }
      extend(bounds_[i], bounds);
    }
  }
}

void PosedScene::check_in_front() const {
  if (in_front()) return;
  throw DataError(
      fmt::format("model '{}' lies at or behind camera {} (nearest vertex at z = {:.3g} m); "
                  "expected a pose in front of every camera",
                  behind_.part->item->name, behind_.view, behind_.nearest));
}

}  // namespace hypotrack::internal
