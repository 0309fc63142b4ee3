#pragma once

#include <Eigen/Core>
#include <random>
#include <span>

#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack::test {

/// Makes a right hand of six closed, overlapping capsules without texture: 21 bones, 21 landmarks,
/// 1,500 vertices, 2,976 triangles. It has 27 parameters: pose, then abduction and three flexions
/// per finger from thumb to little. Frame: origin at the wrist, +X to the thumb, +Y to the
/// fingertips, +Z out of the palm.
ModelData make_test_hand();

/// Makes a box of the given size (metres) about the origin: 8 vertices, 12 triangles, 7 parameters.
ModelData make_test_box(const Eigen::Vector3d& size = {0.06, 0.04, 0.12});

/// Makes a cabinet of boxes with joints of all kinds. A drawer slides by `drawer` (m). A door turns
/// by `door` (rad), and a knob on it turns without end by `knob`. A latch turns and slides with the
/// door. A shelf slides against the drawer, half as far.
ModelData make_test_cabinet();

/// Makes a rigid ball about the model's origin, of 32 x 64 faces.
ModelData make_test_ball(double radius);

/// Makes a scene of this hand and this box, in that order.
Scene make_hand_and_box();

/// Returns the numbers of a state or of a model's parameters.
inline std::span<const double> values_of(const Eigen::VectorXd& state) {
  return {state.data(), static_cast<std::size_t>(state.size())};
}

/// Returns a state of the scene with joints uniform within their bounds (up to a turn each way
/// without any), rotations uniform, and
/// positions uniform within `radius` of `center` along each axis.
Eigen::VectorXd random_state(const Scene& scene, std::mt19937_64& random,
                             const Eigen::Vector3d& center = {0, 0, 0.5}, double radius = 0.05);

}  // namespace hypotrack::test
