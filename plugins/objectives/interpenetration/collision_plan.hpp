#pragma once

#include <string>
#include <vector>

#include "collision_term.hpp"
#include "hypotrack/scene.hpp"
#include "hypotrack/skeleton.hpp"

namespace hypotrack::interpenetration {

/// What may collide in a scene: all shapes of different models; within a model those of bones that
/// no joint connects, as far as they are deeper in each other than at rest. Bones that do not move
/// against each other (a palm's) count as one.
struct CollisionPlan {
  /// `tolerance` in metres: depth that every pair may have. Throws ConfigError, naming `where`, if
  /// a model poses itself: then its bones do not say where it is.
  CollisionPlan(const Scene& scene, double tolerance, bool within_models, const std::string& where);

  /// Points into this object.
  CollisionTerm term() const;

  Skeleton skeleton;
  std::vector<Shape> shapes;
  std::vector<Pair> pairs;
};

}  // namespace hypotrack::interpenetration
