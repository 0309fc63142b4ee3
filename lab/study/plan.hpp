#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "lab/study/noise.hpp"
#include "lab/study/study_file.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// One scene at one point of the grid.
struct Cell {
  std::size_t scene = 0;             ///< index into Study::scenes
  std::vector<std::size_t> choices;  ///< index into the choices of each axis
  std::optional<NoiseSeed> noise;    ///< what runs redraw, if they do
};

/// One run: a cell with a seed.
struct PlannedRun {
  std::size_t cell = 0;
  std::int64_t seed = 0;
  std::string id;  ///< name of its folder
};

/// Every run of a study. Cells are in the order of the file, the last axis fastest. Runs are in the
/// order in which they are made: all cells with the first seed before any with the second.
///
/// A run's id consists of the scene's name, the seed and a hash of all that decides the result: the
/// content of the scene file, all changes with their includes, the seed, the noise and the number
/// of frames. So a study may grow (further seeds, values, scenes) and keeps its runs.
struct Plan {
  Study study;
  std::vector<std::string> scene_texts;  ///< text of each scene's file, with its includes
  std::vector<Cell> cells;
  std::vector<PlannedRun> runs;

  const StudyScene& scene_of(const Cell& cell) const { return study.scenes[cell.scene]; }
  const Choice& choice_of(const Cell& cell, std::size_t axis) const {
    return study.axes[axis].choices[cell.choices[axis]];
  }
  /// Returns the changes to the scene, in the order in which they apply.
  std::vector<Change> changes_of(const Cell& cell) const;
  /// Returns the changes of the run's cell and what its seed redraws.
  std::vector<Change> changes_of(const PlannedRun& run) const;
  /// Returns a description for messages: `sh_stereo, optimizer.particles 32`.
  std::string describe(const Cell& cell) const;
};

/// A part of the runs, for one of several machines.
struct Shard {
  std::size_t index = 0;  ///< from 0
  std::size_t count = 1;
};

/// Plans all runs. Throws ConfigError if a scene file cannot be read or the study has more than
/// 100,000 runs.
Plan make_plan(Study study);

/// Returns the indices of the runs of a shard. Each cell's seeds are distributed over the shards,
/// so that no shard gets all the slow cells.
std::vector<std::size_t> runs_of(const Plan& plan, Shard shard);

}  // namespace internal
}  // namespace hypotrack::study
