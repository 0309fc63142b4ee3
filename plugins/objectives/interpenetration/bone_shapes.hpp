#pragma once

#include <vector>

#include "collision_shape.hpp"
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

}  // namespace hypotrack::interpenetration
