#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

namespace hypotrack::hand_mesh {

/// The measures of one digit, millimetres. Breadths are radio-ulnar, depths palmo-dorsal.
struct DigitMeasures {
  const char* name;
  double metacarpal;  ///< bone lengths; a thumb's "middle" is absent (0)
  double proximal;
  double middle;
  double distal;
  double tip;                            ///< soft tissue beyond the distal phalanx
  double pip_breadth;                    ///< across the PIP joint; of the thumb: the MCP joint
  double dip_breadth;                    ///< across the DIP joint; of the thumb: the IP joint
  Eigen::Vector3d base;                  ///< proximal end of the metacarpal, hand frame
  Eigen::Vector3d metacarpal_direction;  ///< of the fixed metacarpals; unused for the thumb
  double twist;      ///< turn of the flexion axes about the digit's own axis, radians
  double abduction;  ///< bind pose, radians: the first moving bone's abduction, the three flexions
  std::array<double, 3> flexion;
};

inline constexpr int kDigits = 5;  ///< thumb, index, middle, ring, little
inline constexpr int kThumb = 0;
inline constexpr int kBonesPerDigit = 4;
inline constexpr int kBones = 1 + kDigits * kBonesPerDigit;

/// Whole-hand measures that the surface aims at, millimetres.
inline constexpr double kHandLength =
    189.0;  ///< wrist crease to the tip of the straight middle finger
inline constexpr double kHandBreadth = 84.0;   ///< across the heads of metacarpals 2 to 5
inline constexpr double kWristBreadth = 60.0;  ///< at the wrist crease
inline constexpr double kStumpLength = 12.0;   ///< forearm kept behind the wrist crease

/// Mean adult male values.
///
/// Lengths of metacarpals, phalanges and the soft tissue of the tips: A. Buryanov and V. Kotiuk,
/// "Proportions of hand segments", Int. J. Morphology 28(3), 2010, table of means. Breadths of the
/// joints: J. W. Garrett, "The adult human hand: some anthropometric and biomechanical
/// considerations", Human Factors 13(2), 1971; T. M. Greiner, "Hand anthropometry of U.S. Army
/// personnel", TR-92/011, 1991. The positions of the metacarpals' bases follow from those lengths,
/// the hand's length and breadth and the slope of the knuckles.
const std::array<DigitMeasures, kDigits>& digit_measures();

/// One bone of the skeleton at the bind pose. Its y axis points along the bone, flexion is a
/// positive rotation about x, z is palmar (a thumb's pad faces z).
struct SkeletonBone {
  std::string name;
  int parent = -1;
  double length = 0;                 ///< millimetres, including the soft tissue of a tip
  Eigen::Isometry3d hand_from_bone;  ///< millimetres
};

/// wrist, then four bones per digit: `<digit>_0` (fixed: a metacarpal, the thumb's trapezium), then
/// the three that move.
std::vector<SkeletonBone> bind_skeleton();

/// Index of a digit's bone, 0 <= k < kBonesPerDigit.
constexpr int bone_index(int digit, int k) { return 1 + digit * kBonesPerDigit + k; }

/// hand_from_bone of every bone with each digit at {abduction, three flexions} instead of the bind
/// pose's angles. Zero angles are the flat, straight hand: fingers along +Y of the hand, the thumb
/// at 45 degrees in the plane of the palm with its pad turned 60 degrees towards the fingers. A
/// digit's first moving bone stands at zero * rot(-z, abduction) rot(y, twist) rot(x, flexion).
std::vector<Eigen::Isometry3d> pose_skeleton(
    const std::array<std::array<double, 4>, kDigits>& angles);

}  // namespace hypotrack::hand_mesh
