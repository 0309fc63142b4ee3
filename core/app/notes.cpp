#include "notes.hpp"

#include <string>

#include "camera/pair_check.hpp"
#include "tell.hpp"

namespace hypotrack::app {

void tell_notes(const Source& source, const SceneTracker& tracker, const Frame& first) {
  for (const std::string& note : source.notes()) tell("note: {}\n", note);
  for (const std::string& problem :
       {problem_of_pair(source.cameras(), first), tracker.problem_of_start(first)})
    if (!problem.empty()) tell("note: {}\n", problem);
}

}  // namespace hypotrack::app
