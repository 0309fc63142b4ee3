#pragma once

#include "hand_detection.hpp"
#include "hand_model.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack::landmarks {

/// A detected hand as directions from a camera. They stay the same in every tile of the frame.
struct SeenHand {
  HandPoints3D directions;  ///< unit vectors along the world's axes
  double distance = 0;      ///< metres, at which an average hand looks as large; > 0
  double presence = 0;      ///< probability that there is a hand
  double right = 0;         ///< probability that it is a right hand
};

/// Returns where a camera is in the world.
Eigen::Vector3d eye_of(const TileCamera& camera);

/// Returns a hand that was detected in a tile. Not all numbers are finite if its landmarks are
/// not, or coincide.
SeenHand seen_hand(const HandDetection& detection, const TileCamera& camera);

/// Returns where points of the world are in a tile; NaN where they are at or behind the camera.
HandPoints in_tile(const HandPoints3D& points, const TileCamera& camera);

/// Returns where a hand that was detected from the same place is in a tile; NaN behind the camera.
HandPoints in_tile(const SeenHand& hand, const TileCamera& camera);

/// Returns a hand moved, turned and scaled in the picture as a model has from one pose to another.
/// NaN of the model do not count; not all numbers are finite if that leaves no two points.
HandPoints moved(const HandPoints& hand, const HandPoints& from, const HandPoints& to);

/// Returns unit vectors from a camera to points of the world.
HandPoints3D directions_to(const HandPoints3D& points, const TileCamera& camera);

/// Returns the mean of directions; those that are NaN do not count. NaN if all are.
Eigen::Vector3d center_of(const HandPoints3D& directions);

/// Returns how large a hand looks: twice its reach from its centre, radians. NaN do not count.
double apparent_size(const HandPoints3D& directions);

/// Returns the mean angle between directions, without NaN ones.
double mean_angle(const HandPoints3D& a, const HandPoints3D& b);

}  // namespace hypotrack::landmarks
