#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "hypotrack/scene.hpp"

namespace hypotrack::synthetic {

/// A number over time through keys: cubic Hermite with monotone slopes (Fritsch and Butland, "A
/// method for constructing local monotone piecewise cubic interpolants", 1984), so it is C1, comes
/// to rest at both ends, stays there, and never leaves the range of the two keys around it.
class NumberTrack {
 public:
  /// Times must ascend.
  void add(double time, double value);
  bool empty() const { return times_.empty(); }
  double at(double time) const;

 private:
  std::vector<double> times_;
  std::vector<double> values_;
};

/// A rotation over time through keys, C1 and at rest at both ends: cubic Bezier curves of unit
/// quaternions (Kim, Kim and Shin, "A general construction scheme for unit quaternion curves with
/// simple high order derivatives", 1995) with angular velocities chosen like NumberTrack's slopes,
/// per axis of the body. Between two keys it takes the shorter way.
class RotationTrack {
 public:
  /// Times must ascend; the quaternion must be of unit length.
  void add(double time, Eigen::Quaterniond rotation);
  bool empty() const { return times_.empty(); }
  Eigen::Quaterniond at(double time) const;

 private:
  Eigen::Vector3d velocity_at_key(std::size_t key) const;
  std::vector<double> times_;
  std::vector<Eigen::Quaterniond> rotations_;
};

/// The state of a scene over time. What no key names stays at its rest value.
class Motion {
 public:
  explicit Motion(const Scene& scene);

  /// A position or an angle, by its place in the state.
  void add_number(int parameter, double time, double value);
  /// The rotation of a model, by its place in the scene.
  void add_rotation(std::size_t model, double time, const Eigen::Quaterniond& rotation);
  /// Whether a position or angle has a key.
  bool has_number(int parameter) const;

  /// Quaternions are of unit length and keep their sign from moment to moment.
  Eigen::VectorXd state(double time) const;

 private:
  Eigen::VectorXd rest_;
  std::vector<int> offsets_;  // of the models in the state
  std::vector<NumberTrack> numbers_;
  std::vector<RotationTrack> rotations_;
};

}  // namespace hypotrack::synthetic
