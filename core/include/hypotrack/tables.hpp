#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"

// Tables of states and landmarks as CSV: a header line of column names, then one line per frame.
//
//   states:     frame,time,<parameter>,...            named as in Scene::parameters(), metres,
//   radians landmarks:  frame,time,<landmark>_x,<landmark>_y,<landmark>_z,...   named as in
//               Scene::landmark_names(), world axes, metres; `absent` where the model is known not
//               to be in view
//
// Reading is liberal in what makes no difference: any order of columns; `frame` may be missing
// (rows are then frames 0, 1, 2, ...) and so may `time`; names may leave out the model
// (`index_tip_x` for `hand.index_tip_x`) where that fits one model only; blank lines, lines that
// begin with #, CRLF line ends, a byte order mark and quotes around a cell are passed over. Rows
// come back sorted by frame.

namespace hypotrack {

struct StateRow {
  int frame = 0;
  double time = 0;        ///< seconds; 0 without a time column
  Eigen::VectorXd state;  ///< Scene::dimension() numbers
};

struct LandmarkRow {
  int frame = 0;
  double time = 0;             ///< seconds; 0 without a time column
  Eigen::Matrix3Xd landmarks;  ///< 3xL, world, metres; NaN: unknown
  std::vector<bool> absent{};  ///< L: NaN because the model is absent; empty: none is
};

/// Reads states. Columns that are no parameter are passed over, so that a `track.csv` is a table of
/// states. Quaternions are normalised. Throws DataError, naming file and line, on unreadable files,
/// missing columns, cells that are no finite numbers, rows of another length, duplicate columns or
/// frames, and files over 256 MiB.
HYPOTRACK_API std::vector<StateRow> read_states(const std::filesystem::path& file,
                                                const Scene& scene);

struct LandmarkTableOptions {
  double metres_per_unit = 1;  ///< 1e-3 for a table in millimetres
  /// `name=landmark` gives a column triple of the file to a landmark of the scene; `name=` drops
  /// it.
  std::vector<std::string> rename;
  /// Whose landmarks `landmark_names` are, in messages.
  std::string owner = "the scene";
};

/// Reads landmarks. Empty cells and `nan` are unknown, and so are landmarks without columns; of one
/// that is absent a cell says `absent`. Throws
/// DataError where read_states does, on names that are not among `landmark_names` (rename them),
/// and on renamings of what the table does not have.
HYPOTRACK_API std::vector<LandmarkRow> read_landmarks(const std::filesystem::path& file,
                                                      std::span<const std::string> landmark_names,
                                                      const LandmarkTableOptions& options = {});

/// Write tables that read back to the same numbers, bit for bit. The file appears when it is
/// complete. Throw OutputError if it cannot be written.
HYPOTRACK_API void write_states(const std::filesystem::path& file, const Scene& scene,
                                std::span<const StateRow> rows);
HYPOTRACK_API void write_landmarks(const std::filesystem::path& file,
                                   std::span<const std::string> landmark_names,
                                   std::span<const LandmarkRow> rows);

}  // namespace hypotrack
