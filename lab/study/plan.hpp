#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "lab/study/study_file.hpp"

namespace hypotrack::study {

/// One scene at one point of the grid.
struct Cell {
  std::size_t scene = 0;             ///< index into Study::scenes
  std::vector<std::size_t> choices;  ///< index into the choices of each axis
};

/// One run: a cell with a seed.
struct PlannedRun {
  std::size_t cell = 0;
  std::int64_t seed = 0;
  std::string id;  ///< name of its folder
};

/// Every run of a study. Cells are in the order of the file, the last axis fastest; runs are in the
/// order in which they are made, all cells with the first seed before any with the second.
///
/// A run's id is made of the scene's name, the seed and a hash of all that decides the result: the
/// content of the scene file, every change, what they take from other scenes, the seed and the
/// number of frames. So a study may grow (further seeds, values, scenes) and keeps the runs it has.
struct Plan {
  Study study;
  std::vector<std::string> scene_texts;  ///< of each scene's file, with what it takes from others
  std::vector<Cell> cells;
  std::vector<PlannedRun> runs;

  const StudyScene& scene_of(const Cell& cell) const { return study.scenes[cell.scene]; }
  const Choice& choice_of(const Cell& cell, std::size_t axis) const {
    return study.axes[axis].choices[cell.choices[axis]];
  }
  /// The changes to the scene, in the order in which they apply.
  HYPOTRACK_API std::vector<Change> changes_of(const Cell& cell) const;
  /// For messages: `sh_stereo, optimizer.particles 32`.
  HYPOTRACK_API std::string describe(const Cell& cell) const;
};

/// A part of the runs, for one of several machines.
struct Shard {
  std::size_t index = 0;  ///< from 0
  std::size_t count = 1;
};

/// Throws ConfigError if a scene file cannot be read or the study has more than 100,000 runs.
HYPOTRACK_API Plan make_plan(Study study);

/// Indices of the runs of a shard. Shards share out the seeds of every cell, so that none gets all
/// the slow ones.
HYPOTRACK_API std::vector<std::size_t> runs_of(const Plan& plan, Shard shard);

}  // namespace hypotrack::study
