#include "the_hand.hpp"

#include <Eigen/Geometry>
#include <numbers>

namespace hypotrack::hand_mesh {

const HandAsset& the_hand() {
  static const HandAsset hand = make_hand(1024);
  return hand;
}

DigitAngles in_radians(DigitAngles degrees) {
  for (auto& digit : degrees)
    for (double& angle : digit) angle *= std::numbers::pi / 180;
  return degrees;
}

DigitAngles bind_angles() {
  DigitAngles angles;
  for (int d = 0; d < kDigits; ++d) {
    const DigitMeasures& m = digit_measures()[d];
    angles[d] = {m.abduction, m.flexion[0], m.flexion[1], m.flexion[2]};
  }
  return angles;
}

DigitAngles flat_angles() { return {}; }

DigitAngles fist_angles() {
  return in_radians(
      {{{30, 25, 35, 55}, {0, 90, 100, 70}, {0, 90, 100, 70}, {0, 90, 100, 70}, {0, 90, 100, 70}}});
}

DigitAngles pinch_angles() {
  return in_radians(
      {{{4, 39, 4, 5}, {-8, 35, 63, 46}, {0, 30, 40, 20}, {-2, 22, 32, 18}, {-6, 18, 25, 15}}});
}

std::vector<Eigen::Vector3d> posed(const DigitAngles& angles) {
  const HandAsset& hand = the_hand();
  return skin(hand.mesh, hand.weights, hand.skeleton, pose_skeleton(angles));
}

double volume(const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& vertices) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += vertices[t[0]].dot(vertices[t[1]].cross(vertices[t[2]])) / 6;
  return sum;
}

}  // namespace hypotrack::hand_mesh
