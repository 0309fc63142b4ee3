// Tables of states. Written and read again they are the same.

#include "fuzz_scenes.hpp"
#include "hypotrack/api/tables.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(states, "csv") {
  const auto rows = read_states(scratch_file("states.csv", bytes), hand_and_box());
  for (const StateRow& row : rows) require(row.state.allFinite(), "states are finite");
  const std::filesystem::path again = scratch() / "states_again.csv";
  write_states(again, hand_and_box(), rows);
  require(read_states(again, hand_and_box()).size() == rows.size(), "no row is lost");
}

}  // namespace hypotrack::fuzz
