#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hypotrack/api/export.hpp"
#include "hypotrack/api/scene.hpp"

// Tables of states and landmarks as CSV: a header line of column names, then one line per frame.
//
//   states:     frame,time,<parameter>,...
//               named as in Scene::parameters(); metres, radians
//   landmarks:  frame,time,<landmark>_x,<landmark>_y,<landmark>_z,...
//               named as in Scene::landmark_names(); world axes, metres; `absent` if the model is
//               known to be out of view
//
// The reader accepts any order of columns. Without `frame`, rows are frames 0, 1, 2, ...; `time` is
// optional. A name may omit the model (`lid_x` for `box.lid_x`) if only one model has
// it. The reader ignores blank lines, lines that begin with #, CRLF line ends, a byte order mark
// and quotes around a cell. Rows are returned sorted by frame.

namespace hypotrack {

/// A row of a table of states.
struct StateRow {
  int frame = 0;
  double time = 0;        ///< seconds; 0 without a time column
  Eigen::VectorXd state;  ///< Scene::dimension() numbers
};

/// A row of a table of landmarks.
struct LandmarkRow {
  int frame = 0;
  double time = 0;             ///< seconds; 0 without a time column
  Eigen::Matrix3Xd landmarks;  ///< 3xL, world, metres; NaN = unknown
  std::vector<bool> absent{};  ///< L, true where the model is absent (NaN); empty = none
};

/// Reads a table of states and normalises their quaternions. Other columns are ignored, so that a
/// `track.csv` is a table of states. Throws DataError, naming file and line, on unreadable files,
/// missing columns, cells that are not finite numbers, rows of another length, duplicate columns or
/// frames, and files over 256 MiB.
HYPOTRACK_API std::vector<StateRow> read_states(const std::filesystem::path& file,
                                                const Scene& scene);

/// Options of read_landmarks().
struct LandmarkTableOptions {
  double metres_per_unit = 1;  ///< 1e-3 for a table in millimetres
  /// `name=landmark` assigns a column triple of the file to a landmark of the scene; `name=` drops
  /// it.
  std::vector<std::string> rename = {};
  /// The owner of `landmark_names` in messages.
  std::string owner = "the scene";
};

/// Reads a table of landmarks. Empty cells, `nan` and landmarks without columns are unknown;
/// `absent` marks a landmark of an absent model. Throws DataError as read_states() does, on names
/// that are not in `landmark_names` (rename them), and on renamings of columns that the table
/// lacks.
HYPOTRACK_API std::vector<LandmarkRow> read_landmarks(const std::filesystem::path& file,
                                                      std::span<const std::string> landmark_names,
                                                      const LandmarkTableOptions& options = {});

/// Returns the header line of a table of landmarks.
HYPOTRACK_API std::string landmarks_header(std::span<const std::string> landmark_names);
/// Returns a line of a table: numbers with as many digits as repeat them exactly.
HYPOTRACK_API std::string table_line(int frame, double time,
                                     const Eigen::Ref<const Eigen::VectorXd>& values);
/// Returns nanoseconds (Frame::stamp) as seconds with nine decimals, which keep every digit:
/// 1403636579.763555584.
HYPOTRACK_API std::string stamp_text(std::int64_t nanoseconds);

/// Write tables that read back bit for bit. The file appears only when it is complete. Throw
/// OutputError if it cannot be written.
HYPOTRACK_API void write_states(const std::filesystem::path& file, const Scene& scene,
                                std::span<const StateRow> rows);
HYPOTRACK_API void write_landmarks(const std::filesystem::path& file,
                                   std::span<const std::string> landmark_names,
                                   std::span<const LandmarkRow> rows);

}  // namespace hypotrack
