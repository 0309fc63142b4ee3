#include "check_scene.hpp"

#include <utility>

#include "hypotrack/error.hpp"
#include "notes.hpp"
#include "output/run_output.hpp"
#include "session/opened_scene.hpp"
#include "tell.hpp"
#include "track/scene_tracker.hpp"

namespace hypotrack::app {

CheckedScene check_scene(const std::filesystem::path& file, std::span<const std::string> overrides,
                         PluginLoader& plugins) {
  OpenedScene session = open_scene(file, overrides, plugins);
  check_outputs(session.outputs);
  const auto first = session.source->next();
  if (!first) throw DataError("the source has no frame");
  CheckedScene checked;
  checked.problem = first->problem;
  const bool usable = first->problem.empty();
  if (!usable) tell("frame {} cannot be used: {}\n", first->index, first->problem);
  checked.parameters = session.scene->dimension();
  checked.models = session.scene->items().size();
  checked.cameras = session.parts.cameras.size();
  checked.frames = session.source->frame_count();
  (void)make_fixed_lag_smoother(session);
  SceneTracker tracker(*session.scene, std::move(session.parts),
                       usable ? initial_state(session, *first) : session.scene->rest_state(),
                       session.seed);
  if (usable) {
    tracker.check(*first);
    for (const std::string& note : session.notes) tell("note: {}\n", note);
    tell_notes(*session.source, tracker, *first);
  }
  checked.backend = tracker.backend();
  checked.resolved = std::move(session.resolved);
  return checked;
}

}  // namespace hypotrack::app
