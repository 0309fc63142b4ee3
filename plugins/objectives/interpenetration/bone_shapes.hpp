#pragma once

#include <vector>

#include "collision_shape.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack::interpenetration {

/// Shapes that fill a model, from its mesh at the bind pose and the bone that holds each vertex
/// most. A rigid model whose mesh fills its bounding box is that box. Every other bone gets
/// capsules, towards the next joint or along the largest spread of its vertices: one, or as many
/// beside each other as there is room for. Their radius is the median distance of their axis from
/// the surface, and they end where a sphere would stick out. `Shape::bone` is an index into the
/// model's bones; a bone that holds fewer than four vertices has no shape.
std::vector<Shape> bone_shapes(const ModelData& data);

}  // namespace hypotrack::interpenetration
