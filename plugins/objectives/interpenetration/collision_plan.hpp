#pragma once

#include <string>
#include <vector>

#include "collision_shape.hpp"
#include "collision_term.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/gpu/skeleton.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack::interpenetration {

/// Fits shapes that fill a model, from its mesh at the bind pose and the bone with the largest
/// weight at each vertex. A rigid model whose mesh fills its bounding box is that box. Every other
/// bone gets capsules towards the next joint, or along the largest variance of its vertices: as
/// many side by side as fit.
///
/// Their radius is the median distance of the axis from the surface. They end where a sphere would
/// stick out. `Shape::bone` is an index into the model's bones. A bone with fewer than four
/// vertices has no shape.
std::vector<Shape> bone_shapes(const ModelData& data);

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
