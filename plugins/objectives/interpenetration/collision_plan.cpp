#include "collision_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "hypotrack/api/error.hpp"

namespace hypotrack::interpenetration {
namespace {

/// Groups of bones that cannot move against each other, and which groups meet in a joint.
class RigidGroups {
 public:
  explicit RigidGroups(const Skeleton& skeleton) {
    for (const cuda::BoneLayout& bone : skeleton.bones) {
      const bool moves = bone.parent < 0 || bone.motion_count > 0;
      const auto own = static_cast<std::int32_t>(of_bone_.size());
      of_bone_.push_back(moves ? own : of(bone.parent));
      above_.push_back(!moves            ? above_[index(bone.parent)]
                       : bone.parent < 0 ? -1
                                         : of(bone.parent));
    }
  }

  /// Returns whether two bones are of one group, or of two that meet.
  bool are_neighbours(std::int32_t a, std::int32_t b) const {
    return of(a) == of(b) || above_[index(a)] == of(b) || above_[index(b)] == of(a);
  }

 private:
  static std::size_t index(std::int32_t bone) { return static_cast<std::size_t>(bone); }
  std::int32_t of(std::int32_t bone) const { return of_bone_[index(bone)]; }

  std::vector<std::int32_t> of_bone_;  // first bone of each bone's group
  std::vector<std::int32_t> above_;    // parent group of each bone's group, or -1
};

std::vector<Shape> shapes_of(const Scene& scene, const std::string& where) {
  std::vector<Shape> shapes;
  std::int32_t first_bone = 0;
  for (const Scene::Item& item : scene.items()) {
    if (item.model->poses_itself()) {
      throw ConfigError(fmt::format(
          "{}: interpenetration: model '{}' poses itself, so its bones do not say where it is; "
          "leave this objective out of the scene",
          where, item.name));
    }
    for (Shape shape : bone_shapes(item.model->data())) {
      shape.bone += first_bone;
      shapes.push_back(shape);
    }
    first_bone += static_cast<std::int32_t>(item.model->data().bones.size());
  }
  return shapes;
}

}  // namespace

CollisionPlan::CollisionPlan(const Scene& scene, double tolerance, bool within_models,
                             const std::string& where)
    : skeleton(scene), shapes(shapes_of(scene, where)) {
  const RigidGroups groups(skeleton);
  const auto model = [&](const Shape& shape) {
    return skeleton.bones[static_cast<std::size_t>(shape.bone)].model;
  };
  const auto count = static_cast<std::int32_t>(shapes.size());
  std::vector<float> scratch(static_cast<std::size_t>(term().scratch_floats()));
  const Eigen::VectorXd rest = scene.rest_state();
  const PosedShape* at_rest = term().pose(rest.data(), OneThread{}, scratch.data());
  for (std::int32_t i = 0; i < count; ++i) {
    for (std::int32_t k = i + 1; k < count; ++k) {
      const Shape &a = shapes[static_cast<std::size_t>(i)],
                  &b = shapes[static_cast<std::size_t>(k)];
      const bool same_model = model(a) == model(b);
      if (same_model && (!within_models || groups.are_neighbours(a.bone, b.bone))) continue;
      Pair pair{i, k, 0};
      if (a.is_box && !b.is_box) std::swap(pair.first, pair.second);
      if (same_model) pair.slack = 1e-3f * term().excess(at_rest, pair);
      pair.slack += static_cast<float>(tolerance);
      pairs.push_back(pair);
    }
  }
}

CollisionTerm CollisionPlan::term() const {
  return {skeleton.layout(), static_cast<std::int32_t>(shapes.size()),
          static_cast<std::int32_t>(pairs.size()), shapes.data(), pairs.data()};
}

}  // namespace hypotrack::interpenetration
