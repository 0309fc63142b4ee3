#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "commands.hpp"
#include "hypotrack/api/error.hpp"
#include "interrupt.hpp"
#include "keeping_frames.hpp"
#include "messages.hpp"
#include "output/recording/recording_writer.hpp"
#include "plugin/plugin_notes.hpp"
#include "progress.hpp"
#include "session/opened_scene.hpp"

namespace hypotrack::app {
namespace {

struct RecordOptions {
  SceneOptions scene;
  std::filesystem::path out;
  std::optional<int> frames;
  double seconds = std::numeric_limits<double>::infinity();
  std::string format = "png";

  bool limited() const { return frames || std::isfinite(seconds); }
};

/// Number of frames of a recording.
struct FrameCounts {
  int all = 0;
  int missing = 0;
};

std::optional<int> total_frames(const Source& source, const RecordOptions& options) {
  const std::optional<int> known = source.frame_count();
  if (!options.frames) return known;
  return known ? std::min(*known, *options.frames) : *options.frames;
}

/// Writes frames until the limits, the end of the source or Ctrl-C. The camera waits for nothing:
/// what it delivers while this thread compresses pictures are frames that it counts as dropped.
void record_frames(Source& source, const RecordOptions& options, const InterruptGuard& interrupt,
                   RecordingWriter& writer, FrameCounts& counts) {
  Progress progress(total_frames(source, options));
  double end = options.seconds;
  while (!options.frames || counts.all < *options.frames) {
    const std::optional<Frame> frame = source.next();
    if (!frame || interrupt.interrupted()) return;
    if (counts.all == 0) end += frame->time;
    if (frame->time >= end) return;
    writer.add(*frame);
    ++counts.all;
    if (!frame->problem.empty()) {
      ++counts.missing;
      progress.say(fmt::format("frame {}: {}", frame->index, frame->problem));
    }
    progress.advance({});
  }
}

void finish(RecordingWriter& writer, const FrameCounts& counts, const Source& source) {
  keeping_frames(writer, [&] { writer.finish(); });
  for (const std::string& line : source.statistics()) fmt::print("{}\n", line);
  fmt::print("{} frames ({} missing); recording in {}\n", counts.all, counts.missing,
             writer.place().string());
}

int record(const RecordOptions& options, const CommonOptions& common) {
  PluginLoader plugins(common.plugin_path);
  const OpenedScene session = open_source(options.scene.scene, options.scene.set, plugins);
  for (const std::string& line : session.plugin_notes->take_lines()) tell("{}\n", line);
  Source& source = *session.source;
  for (const std::string& note : source.notes()) tell("note: {}\n", note);
  RecordingWriter writer(*session.scene, source.cameras(), source.frame_rate(), session.resolved,
                         options.out,
                         options.format == "jpeg" ? PictureFormat::jpeg : PictureFormat::png);
  writer.copy_start(session.init);
  const InterruptGuard interrupt;
  FrameCounts counts;
  try {
    keeping_frames(writer, [&] { record_frames(source, options, interrupt, writer, counts); });
  } catch (const DataError&) {  // the camera is gone
    if (counts.all > counts.missing) finish(writer, counts, source);
    throw;
  }
  if (counts.all == counts.missing) {
    if (!interrupt.interrupted())
      throw DataError("the source gave no usable frame; nothing was written");
    tell("hypotrack: interrupted before the first usable frame; nothing was written\n");
    return kInterruptedExitCode;
  }
  finish(writer, counts, source);
  // Ctrl-C is the usual end of a camera's recording.
  const bool early = interrupt.interrupted() && (options.limited() || source.frame_count());
  if (!early) return 0;
  tell("hypotrack: interrupted; the recording ends early\n");
  return kInterruptedExitCode;
}

}  // namespace

void add_record_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<RecordOptions>();
  const Command command =
      root.add_command("record", "Record a scene's source (a live camera); Ctrl-C ends it");
  add_scene_options(command, options->scene);
  command.add("--out", &options->out, "New folder for the recording",
              {.required = true, .check = file_name()});
  command.add("--frames", &options->frames, "Stop after this many frames",
              {.check = whole_number(1)});
  command.add("--seconds", &options->seconds, "Stop after this time", {.check = positive_number()});
  command.add("--format", &options->format,
              "Pictures: lossless png, or jpeg, which is smaller and faster",
              {.show_default = true, .check = one_of({"png", "jpeg"})});
  command.on_call([=, &common, &exit_code] { exit_code = record(*options, common); });
}

}  // namespace hypotrack::app
