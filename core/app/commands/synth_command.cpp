#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>

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

struct SynthOptions {
  SceneOptions scene;
  std::filesystem::path out;
  std::optional<int> frames;
  std::string format = "png";
};

int synth(const SynthOptions& options, const CommonOptions& common) {
  PluginLoader plugins(common.plugin_path);
  const OpenedScene session = open_source(options.scene.scene, options.scene.set, plugins);
  for (const std::string& line : session.plugin_notes->take_lines()) tell("{}\n", line);
  RecordingWriter writer(*session.scene, session.source->cameras(), session.source->frame_rate(),
                         session.resolved, options.out,
                         options.format == "ppm" ? PictureFormat::ppm : PictureFormat::png,
                         session.parts.evaluate.threads);
  writer.copy_start(session.init);
  InterruptGuard interrupt;
  {
    std::optional<int> total = session.source->frame_count();
    if (options.frames) total = total ? std::min(*total, *options.frames) : *options.frames;
    Progress progress(total);
    for (int done = 0; !options.frames || done < *options.frames; ++done) {
      const auto frame = session.source->next();
      if (!frame || interrupt.interrupted()) break;
      keeping_frames(writer, [&] { writer.add(*frame); });
      progress.advance({});
    }
  }
  if (writer.empty() && interrupt.interrupted()) {
    tell("hypotrack: interrupted before the first frame; nothing was written\n");
    return kInterruptedExitCode;
  }
  keeping_frames(writer, [&] { writer.finish(); });
  fmt::print("{}", motion_text(writer.motion()));
  fmt::print("recording in {}\n", writer.place().string());
  if (!interrupt.interrupted()) return 0;
  tell("hypotrack: interrupted; the recording ends early\n");
  return kInterruptedExitCode;
}

}  // namespace

void add_synth_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<SynthOptions>();
  const Command command = root.add_command(
      "synth", "Write a scene's source as a recording: images, calibration, ground truth");
  add_scene_options(command, options->scene);
  command.add("--out", &options->out, "New folder for the recording",
              {.required = true, .check = file_name()});
  command.add("--frames", &options->frames, "Stop after this many frames",
              {.check = whole_number(1)});
  command.add("--format", &options->format,
              "Pictures: png, or ppm, which is larger and read at once",
              {.show_default = true, .check = one_of({"png", "ppm"})});
  command.on_call([=, &common, &exit_code] { exit_code = synth(*options, common); });
}

}  // namespace hypotrack::app
