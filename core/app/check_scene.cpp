#include "check_scene.hpp"

#include <utility>

#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "messages.hpp"
#include "output/run/run_output.hpp"
#include "session/opened_scene.hpp"
#include "start_drawing.hpp"
#include "track/loop/scene_tracker.hpp"

namespace hypotrack::app {
namespace {

/// Reads the first frame; if it is to be drawn, the first usable one.
Frame first_frame(Source& source, bool draw) {
  std::optional<Frame> frame = source.next();
  if (!frame) throw DataError("the source has no frame");
  while (!frame->problem.empty()) {
    tell("frame {} cannot be used: {}\n", frame->index, frame->problem);
    if (!draw) break;
    frame = source.next();
    if (!frame) throw DataError("no frame of the source can be used, so there is none to draw");
  }
  return std::move(*frame);
}

/// Returns the YAML of a scene's models and source, which decides its frames.
std::string key_of(const OpenedScene& session) {
  const ConfigNode models = ConfigNode::parse(session.resolved, "the scene").get("models");
  return models.to_yaml() + session.source_resolved;
}

}  // namespace

CheckedScene check_scene(const std::filesystem::path& file, std::span<const std::string> overrides,
                         PluginLoader& plugins, const std::optional<std::filesystem::path>& draw,
                         FirstFrames* first_frames) {
  if (draw) check_picture_file(*draw);
  OpenedScene session = open_scene(file, overrides, plugins);
  check_outputs(session.outputs);
  const auto made = [&] {
    return std::make_shared<const Frame>(first_frame(*session.source, draw.has_value()));
  };
  const auto kept = first_frames ? first_frames->get(key_of(session), made) : made();
  const Frame& first = *kept;
  CheckedScene checked;
  checked.problem = first.problem;
  const bool usable = first.problem.empty();
  checked.parameters = session.scene->dimension();
  checked.models = session.scene->items().size();
  checked.cameras = session.parts.cameras.size();
  checked.frames = session.source->frame_count();
  (void)make_fixed_lag_smoother(session);
  const Eigen::VectorXd start =
      usable ? initial_state(session, first, &session.notes) : session.scene->rest_state();
  const bool looks = session.parts.begins_by_looking;
  const TileSettings tile = session.parts.tile;
  const auto draw_on_first = [&](const StartToDraw& drawn) {
    write_picture(*draw, draw_start(*session.scene, session.source->cameras(), tile, first, drawn));
    tell("{}: {}\n", draw->string(), drawn.caption.front());
  };
  // Before anything can fail because of the start: the picture shows why.
  if (draw && !looks) draw_on_first(given_start(session, start, first));
  session.parts.status.recovery.run = RecoveryRun::frame;  // the one frame waits for its search
  SceneTracker tracker(*session.scene, std::move(session.parts), start, session.seed);
  if (usable) {
    tracker.check(first);
    if (draw && looks) draw_on_first(found_start(session, tracker, first));
  }
  for (const std::string& note : session.notes) tell("note: {}\n", note);
  for (const std::string& line : session.plugin_notes->take_lines()) tell("{}\n", line);
  if (usable) {
    tell_notes(*session.source, tracker, first);
    // A cell of a study needs no further frames: they would be drawn anew for each.
    if (!first_frames) tell_faults(*session.source, tracker, first);
  }
  checked.backend = tracker.backend();
  checked.resolved = std::move(session.resolved);
  return checked;
}

}  // namespace hypotrack::app
