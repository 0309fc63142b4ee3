#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "hypotrack/api/scene.hpp"

namespace hypotrack::synthetic {

/// Interpolates a number over time through keys by cubic Hermite splines with monotone slopes
/// (Fritsch and Butland, "A method for constructing local monotone piecewise cubic interpolants",
/// 1984). It is C1, at rest at both ends and beyond, and never leaves the range of the two keys
/// around it.
class NumberTrack {
 public:
  /// Adds a key. Times must ascend.
  void add(double time, double value);
  bool empty() const { return times_.empty(); }
  double at(double time) const;

 private:
  std::vector<double> times_;
  std::vector<double> values_;
};

/// Interpolates a rotation over time through keys, C1 and at rest at both ends. It uses cubic
/// Bezier curves of unit quaternions (Kim, Kim and Shin, "A general construction scheme for unit
/// quaternion curves with simple high order derivatives", 1995). Angular velocities are chosen like
/// NumberTrack's slopes, per axis of the body. Between two keys it takes the shorter way.
class RotationTrack {
 public:
  /// Adds a key. Times must ascend; the quaternion must be of unit length.
  void add(double time, Eigen::Quaterniond rotation);
  bool empty() const { return times_.empty(); }
  Eigen::Quaterniond at(double time) const;

 private:
  Eigen::Vector3d velocity_at_key(std::size_t key) const;
  std::vector<double> times_;
  std::vector<Eigen::Quaterniond> rotations_;
};

/// Position and rotation of a model.
struct Placement {
  Eigen::Vector3d position;  ///< metres
  Eigen::Quaterniond rotation;
};

/// The state of a scene over time. Parameters without keys keep their rest values.
class Motion {
 public:
  explicit Motion(const Scene& scene);

  /// Adds a key of a position or an angle, by its index in the state.
  void add_number(int parameter, double time, double value);
  /// Adds a key of the rotation of a model, by its index in the scene.
  void add_rotation(std::size_t model, double time, const Eigen::Quaterniond& rotation);
  /// Lets a model keep its pose relative to a holder from one time to another (infinite: for good).
  /// Then it stays where it is and moves on to its later keys from rest. Add all keys of the holder
  /// before, which must not be held itself, and the held model's keys up to `from`; add those after
  /// `to` afterwards.
  void add_hold(std::size_t held, std::size_t holder, double from, double to);
  /// Returns whether a position or angle has a key.
  bool has_number(int parameter) const;

  /// Returns the state at a time. Quaternions are of unit length and keep their sign over time.
  Eigen::VectorXd state(double time) const;

 private:
  /// A model's motion between two holds.
  struct Path {
    std::array<NumberTrack, 3> position;
    RotationTrack rotation;
  };
  struct Hold {
    std::size_t holder;
    double from, to;
    Placement holder_from_held;
  };
  /// A model's whole motion: a path, a hold, a path, a hold, ... and a path.
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
  std::vector<NumberTrack> numbers_;  // by parameter; those of poses are unused
};

}  // namespace hypotrack::synthetic
