#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hypotrack::test {

/// What a run folder of a test says; written in the form of `hypotrack run`.
struct RunFixture {
  /// YAML list of the scene's models, opened through the plugin loader.
  std::string models = "[{name: box, type: rigid_box, size_mm: [90, 60, 40]}]";
  int frames = 12;
  double error_mm = 5;  ///< about the mean error
  unsigned seed = 1;
  int lost_from = -1;  ///< first frame of a loss; -1: never lost
  bool truth_states = true;
  bool truth_landmarks = true;
  int worst = 1;        ///< pictures
  bool trace = false;   ///< whether there are trace.csv and truth_costs.csv
  int generation = 16;  ///< evaluations between its rows
};

/// Writes a run folder whose tracked states lie about the true ones.
void write_run(const std::filesystem::path& directory, const RunFixture& run);

/// A study of two scenes over particles and generations, in the form of `hypotrack compare`.
struct StudyFixture {
  RunFixture run = {};
  int seeds = 3;
  std::vector<int> particles{16, 32};
  std::vector<int> generations{16, 64};
  std::string title = "Error over the budget";
  bool trace = false;                ///< of all runs
  std::string plots = {};            ///< YAML of the list; empty: none
  std::string failure_message = {};  ///< not empty: the last run failed with it
  bool same = false;                 ///< whether all seeds of a cell give the same result
  double scene_gain = 0.8;           ///< error of the second scene relative to the first
};

void write_study(const std::filesystem::path& directory, const StudyFixture& study);

}  // namespace hypotrack::test
