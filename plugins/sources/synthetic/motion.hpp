#pragma once

#include <Eigen/Geometry>
#include <array>
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

/// Where a model is.
struct Placement {
  Eigen::Vector3d position;  ///< metres
  Eigen::Quaterniond rotation;
};

/// The state of a scene over time. What no key names stays at its rest value.
class Motion {
 public:
  explicit Motion(const Scene& scene);

  /// A position or an angle, by its place in the state.
  void add_number(int parameter, double time, double value);
  /// The rotation of a model, by its place in the scene.
  void add_rotation(std::size_t model, double time, const Eigen::Quaterniond& rotation);
  /// From one moment to another (infinite: for good) a model keeps its place relative to another
  /// that holds it; then it is left where it is and moves on to its later keys from rest. Needs all
  /// keys of the holder, which must not be held itself, and the held model's keys up to `from`;
  /// those after `to` are added afterwards.
  void add_hold(std::size_t held, std::size_t holder, double from, double to);
  /// Whether a position or angle has a key.
  bool has_number(int parameter) const;

  /// Quaternions are of unit length and keep their sign from moment to moment.
  Eigen::VectorXd state(double time) const;

 private:
  /// A model between two holds.
  struct Path {
    std::array<NumberTrack, 3> position;
    RotationTrack rotation;
  };
  struct Hold {
    std::size_t holder;
    double from, to;
    Placement holder_from_held;
  };
  /// A model's way: a path, a hold, a path, a hold, ... and a path.
  struct Way {
    int offset = 0;  ///< of the model in the state
    std::vector<Path> paths;
    std::vector<Hold> holds;
  };
  Placement placement(const Way& way, double time) const;
  Placement on_path(const Way& way, std::size_t path, double time) const;
  NumberTrack& number(int parameter);

  Eigen::VectorXd rest_;
  std::vector<Way> ways_;             // by model
  std::vector<NumberTrack> numbers_;  // by parameter; a pose's are unused
};

}  // namespace hypotrack::synthetic
