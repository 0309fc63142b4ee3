#pragma once

#include <string>
#include <vector>

#include "collision_term.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/gpu/skeleton.hpp"

namespace hypotrack::interpenetration {

/// The pairs of shapes in a scene that may collide. These are all pairs from different models, and
/// within a model those of bones that no joint connects. A pair within a model may be as deep in
/// each other as at rest. Bones that do not move against each other (a palm's) count as one.
struct CollisionPlan {
  /// `tolerance`, in metres, is the depth that every pair may have. Throws ConfigError, naming
  /// `where`, if a model poses itself: its bones then do not say where it is.
  CollisionPlan(const Scene& scene, double tolerance, bool within_models, const std::string& where);

  /// Returns a view that points into this object.
  CollisionTerm term() const;

  Skeleton skeleton;
  std::vector<Shape> shapes;
  std::vector<Pair> pairs;
};

}  // namespace hypotrack::interpenetration
