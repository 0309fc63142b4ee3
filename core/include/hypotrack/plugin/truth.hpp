#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/export.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {

/// The parameters by which a source names its ground-truth tables (tables.hpp). A source visits
/// them in its own `visit` (`truth.visit(v)`), so that their keys appear among its own.
struct TruthSettings {
  std::filesystem::path states = {};
  std::filesystem::path landmarks = {};
  LengthUnit units = LengthUnit::m;
  std::vector<std::string> rename = {};
  int offset = 0;

  void visit(ParamVisitor& v) {
    v("truth_states", states,
      {.help = "CSV of true states: frame, time and a column for each parameter of the scene"});
    v("truth_landmarks", landmarks,
      {.help = "CSV of true landmarks: frame, time and <landmark>_x, _y, _z in world axes"});
    v("truth_units", units, {.help = "unit of truth_landmarks: m, cm or mm"});
    v("truth_rename", rename,
      {.help =
           "for truth_landmarks, `name=landmark` gives a name of the table to a landmark of the "
           "scene, `name=` drops it"});
    v("truth_offset", offset,
      {.help =
           "added to the number of an image (%04d), its position (*) or the frame of a video to "
           "get its frame number in the tables"});
  }
};

/// The ground truth of a recording, by frame.
class HYPOTRACK_API TruthTables {
 public:
  /// Creates an empty object, without tables.
  TruthTables() = default;
  /// Reads the tables that the settings name. Throws DataError as read_states() and
  /// read_landmarks().
  TruthTables(const TruthSettings& settings, const Scene& scene);

  /// Returns the ground truth of an image by its number in the recording, to which `truth_offset`
  /// is added; nothing if no table has it.
  std::optional<GroundTruth> at(int number) const;

  /// Throws DataError if the tables have no row for any of the images `first`, `first + step`, ...
  /// Such tables belong to another recording, and the run would silently report no errors. `count`
  /// is the number of images, if known. Does nothing without tables.
  void expect_some(int first, int step, std::optional<int> count) const;

 private:
  std::map<int, GroundTruth> frames_;
  std::string files_;  ///< names of the tables
  int offset_ = 0;
};

}  // namespace hypotrack
