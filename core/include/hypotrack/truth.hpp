#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/calibration.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/params.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// The answer to a recording, as parameters of a source: tables as described in tables.hpp. Visit
/// it from the source's own `visit` (`truth.visit(v)`), so that its keys stand beside the others.
struct TruthSettings {
  std::filesystem::path states;
  std::filesystem::path landmarks;
  LengthUnit units = LengthUnit::m;
  std::vector<std::string> rename;
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

/// Looks the answer up frame by frame.
class HYPOTRACK_API TruthTables {
 public:
  /// Without tables: knows nothing.
  TruthTables() = default;
  /// Reads the tables that are named. Throws DataError as read_states and read_landmarks do.
  TruthTables(const TruthSettings& settings, const Scene& scene);

  /// What the tables say about an image by its number in the recording (which `truth_offset` is
  /// added to); nothing if they do not mention it.
  std::optional<GroundTruth> at(int number) const;

  /// Throws DataError if tables are named and say nothing of the images `first`, `first + step`,
  /// ..., of which there are `count` (any number if that is not known): such tables are of another
  /// recording, and a run would have no errors without a word.
  void expect_some(int first, int step, std::optional<int> count) const;

 private:
  std::map<int, GroundTruth> frames_;
  std::string files_;  ///< names of the tables
  int offset_ = 0;
};

}  // namespace hypotrack
