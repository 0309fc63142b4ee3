// Tables of landmarks. Written and read again they are the same.

#include "fuzz_scenes.hpp"
#include "hypotrack/api/tables.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(landmarks, "csv") {
  const auto names = hand_and_box().landmark_names();
  const auto rows = read_landmarks(scratch_file("landmarks.csv", bytes), names);
  for (const LandmarkRow& row : rows)
    require(!row.landmarks.array().isInf().any(), "landmarks are finite or unknown");
  const std::filesystem::path again = scratch() / "landmarks_again.csv";
  write_landmarks(again, names, rows);
  require(read_landmarks(again, names).size() == rows.size(), "no row is lost");
}

}  // namespace hypotrack::fuzz
