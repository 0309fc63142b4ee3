#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace hypotrack::hand_mesh {

/// The pieces of which the hand's implicit surface is made. All values are roughly signed distances
/// in millimetres: negative inside, exact on the surface.

/// Half extents of a cross-section at `t` in 0 .. 1 along an axis.
struct ProfileKnot {
  double t;
  double width;   ///< radial and ulnar
  double palmar;  ///< towards +z
  double dorsal;  ///< towards -z
};

/// A limb along the y axis of a frame, from y = 0 to y = length, with a cross-section that changes
/// smoothly along it and rounded ends that reach `start_cap` and `end_cap` beyond.
class Limb {
 public:
  Limb(const Eigen::Isometry3d& hand_from_limb, double length, std::vector<ProfileKnot> profile,
       double start_cap, double end_cap, double exponent = 2.0);
  double operator()(const Eigen::Vector3d& p) const;

 private:
  Eigen::Vector3d section(double t) const;

  Eigen::Isometry3d limb_from_hand_;
  double length_;
  std::vector<ProfileKnot> profile_;
  double start_cap_;
  double end_cap_;
  double exponent_;
  Eigen::Vector3d center_;  ///< bounding sphere, hand frame
  double radius_;
};

/// A limb of an ellipsoid's shape: centre in the middle, half extents along the frame's axes.
Limb ellipsoid(const Eigen::Isometry3d& hand_from_ellipsoid, const Eigen::Vector3d& half_extents);

/// Distance to a triangle with rounded edges of the given radius: skin that spans two digits.
double rounded_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                        const Eigen::Vector3d& b, const Eigen::Vector3d& c, double radius);

/// Union of two shapes with a blend that begins where they are `blend` apart (quadratic smooth
/// minimum), and the corresponding intersection.
double smooth_min(double a, double b, double blend);
double smooth_max(double a, double b, double blend);

/// 0 below `low`, 1 above `high`, with a continuous derivative.
double smooth_step(double low, double high, double x);

}  // namespace hypotrack::hand_mesh
