#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/config.hpp"

// The cameras of an OAK board, by their sockets, and where they stand to each other.

namespace hypotrack::calibration {
inline namespace HYPOTRACK_EXPORTED internal {

constexpr int kNoSocket = -1;

/// A camera of a board, and where it stands to another one.
struct BoardCamera {
  ConfigNode node;
  std::string path;  ///< of the node in the file, as in KeyPaths
  int to = kNoSocket;
  /// p_to = R p_camera + T; nothing where the file has zeros or no rotation.
  std::optional<Eigen::Isometry3d> to_from_camera;
  std::vector<std::string> notes = {};  ///< on the extrinsics
};

using Board = std::map<int, BoardCamera>;

/// Reads a socket: a number, its name (CAM_B), or the name of the camera there (LEFT). Throws
/// DataError, naming `where`.
int read_socket(const std::string& text, const std::string& where);

/// Reads the cameras of `cameraData` that have intrinsics: a list of pairs of a socket and a
/// camera, or a map. The paths of all others go to `empty`.
Board read_board(const ConfigNode& data, double metres, std::vector<std::string>& empty);

/// Returns the pose of one camera in the frame of another one, along the file's chain of poses.
std::optional<Eigen::Isometry3d> pose_between(const Board& board, int from, int to);

}  // namespace internal
}  // namespace hypotrack::calibration
