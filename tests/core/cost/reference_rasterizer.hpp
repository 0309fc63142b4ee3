#pragma once

#include <Eigen/Core>

#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack::test {

/// 1/z of the nearest surface at every pixel centre (height x width), 0 where there is none: every
/// pixel of every triangle's bounding box, in double precision, without culling. Triangles with a
/// corner that is not drawable (see kNear in simd_kernels.hpp) are left out.
Eigen::MatrixXd reference_inverse_depth(const Scene& scene, const Eigen::VectorXd& state,
                                        const TileCamera& camera);

}  // namespace hypotrack::test
