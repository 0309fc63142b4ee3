#include "track/color/highlights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hypotrack::internal {
namespace {

constexpr int kLights = 128;  // 18 degrees apart; half vectors are 9 apart and highlights 24 wide
constexpr float kFar = 20;    // of 255: a sample with this residual counts half
constexpr float kRidge = 1;   // ridge regularisation, in samples that say there is no light
constexpr int kSweeps = 30;

/// Returns directions that cover the sphere evenly (Fibonacci lattice).
Eigen::Matrix3Xf make_lights() {
  const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
  Eigen::Matrix3Xf lights(3, kLights);
  for (int i = 0; i < kLights; ++i) {
    const double z = 1 - (2 * i + 1.0) / kLights;
    const double r = std::sqrt(1 - z * z);
    lights.col(i) =
        Eigen::Vector3d(r * std::cos(i * turn), r * std::sin(i * turn), z).cast<float>();
  }
  return lights;
}

/// Computes the reflection of every light of strength 1 to a camera (L x N).
Eigen::ArrayXXf reflected(const Eigen::Matrix3Xf& normals, const Eigen::Vector3d& to_camera) {
  static const Eigen::Matrix3Xf lights = make_lights();
  const Eigen::Matrix3Xf half = (lights.colwise() + to_camera.cast<float>()).colwise().normalized();
  Eigen::ArrayXXf power = (half.transpose() * normals).array().max(0.0f);
  for (int i = 0; i < 5; ++i) power = power.square();  // to the 32nd
  return power;
}

Eigen::MatrixXf difference(const Eigen::Matrix3Xf& normals, const ViewDirections& to) {
  return reflected(normals, to.first) - reflected(normals, to.other);
}

}  // namespace

void Highlights::learn(const Eigen::Matrix3Xf& normals, const Eigen::VectorXf& differences,
                       const ViewDirections& to) {
  if (strength_.size() == 0) {
    products_.setZero(kLights, kLights);
    sums_.setZero(kLights);
    strength_.setZero(kLights);
  }
  const Eigen::MatrixXf lights = difference(normals, to);
  const Eigen::ArrayXf off = (differences - lights.transpose() * strength_).array() / kFar;
  const Eigen::VectorXf weight = (1 + off.square()).inverse();
  const Eigen::MatrixXf weighted = lights * weight.asDiagonal();
  products_ = kept_ * products_ + weighted * lights.transpose();
  sums_ = kept_ * sums_ + weighted * differences;
  // Non-negative least squares by coordinate descent.
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (Eigen::Index l = 0; l < kLights; ++l) {
      const float rest = sums_[l] - products_.col(l).dot(strength_) - kRidge * strength_[l];
      strength_[l] = std::max(0.0f, strength_[l] + rest / (products_(l, l) + kRidge));
    }
  }
}

void Highlights::forget() {
  products_.setZero();
  sums_.setZero();
}

Eigen::VectorXf Highlights::expected(const Eigen::Matrix3Xf& normals,
                                     const ViewDirections& to) const {
  if (strength_.size() == 0) return Eigen::VectorXf::Zero(normals.cols());
  return difference(normals, to).transpose() * strength_;
}

}  // namespace hypotrack::internal
