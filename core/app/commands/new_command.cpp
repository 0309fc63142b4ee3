#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/text_file.hpp"
#include "calibrate/picture_pairs.hpp"
#include "cameras/camera_options.hpp"
#include "check_scene.hpp"
#include "commands.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"
#include "interrupt.hpp"
#include "messages.hpp"
#include "new_scene/scene_request.hpp"

namespace hypotrack::app {
namespace {

/// What the command line says of a new scene.
struct NewSceneOptions {
  std::filesystem::path file;
  std::vector<std::filesystem::path> recording;
  CameraOptions views;
  std::filesystem::path calibration, extrinsics;
  std::vector<std::string> cameras;
  std::string units, model, box, tracker;
  std::optional<std::string> scale;
  bool force = false;
};

std::vector<std::string> model_words() {
  return {"hand", "left_hand", "two_hands", "hand_and_box", "box"};
}
std::vector<std::string> tracker_words() { return {"real", "recommended", "real_time", "rigid"}; }

/// Throws ConfigError if a word is none of those.
void expect_one_of(const std::vector<std::string>& words, const std::string& word) {
  if (std::ranges::find(words, word) != words.end()) return;
  const std::string hint = did_you_mean(word, words);
  throw ConfigError(
      fmt::format("found '{}', expected one of {}{}", word, fmt::join(words, ", "), hint));
}

/// Returns a path as typed, with a leading ~/ replaced as a shell would.
std::filesystem::path typed_path(const std::string& text) {
  const char* home = std::getenv("HOME");
  if (!home || !text.starts_with("~/")) return text;
  return std::filesystem::path(home) / text.substr(2);
}

/// Finds the views in a folder, two videos, or one video with both side by side.
RecordingFiles recording_at(const std::vector<std::filesystem::path>& paths) {
  if (paths.size() > 2)
    throw ConfigError(fmt::format(
        "--recording: found {}, expected one folder, one video of both views, or two videos",
        paths.size()));
  for (const std::filesystem::path& path : paths) {
    if (!std::filesystem::exists(path))
      throw DataError(
          fmt::format("{}: there is no such file or folder; expected a folder of "
                      "pictures, or a video",
                      path.string()));
    if (paths.size() == 1 && std::filesystem::is_directory(path)) return find_recording(path);
    if (!calibrate::is_video(path))
      throw DataError(fmt::format(
          "{}: is no video by its name; expected a folder, or .mp4, .avi, .mkv and the like",
          path.string()));
  }
  RecordingFiles files;
  if (paths.size() == 1) files.side_by_side = paths[0];
  if (paths.size() == 2) files.left = paths[0];
  if (paths.size() == 2) files.right = paths[1];
  return files;
}

/// Finds the pictures, videos or live cameras of both views, without their calibration.
RecordingFiles views_of(const NewSceneOptions& options) {
  const CameraOptions& views = options.views;
  RecordingFiles files;
  const bool both = views.layout && !views.left.empty();  // in one picture
  if (views.left.empty() != views.right.empty() && !both)
    throw ConfigError(fmt::format("{} is not given; expected --left and --right together",
                                  views.left.empty() ? "--left" : "--right"));
  if (names_cameras(views)) {
    if (!options.recording.empty())
      throw ConfigError("--recording and --device are given; expected one of them");
    files.live = views;
  } else if (!views.left.empty()) {
    if (!both && calibrate::is_video(views.left) != calibrate::is_video(views.right))
      throw ConfigError("--left and --right: one is a video; expected both or none");
    files.left = views.left;
    files.right = views.right;
  } else if (!options.recording.empty()) {
    files = recording_at(options.recording);
  } else {
    ask({.option = "--recording",
         .text = "a folder with pictures or videos of both views, or a video of them side by side"},
        [&](const std::string& answer) { files = recording_at({typed_path(answer)}); });
  }
  if (!files.live) files.layout = views.layout;
  if (files.layout && !files.right.empty())
    throw ConfigError(
        "--layout says how one picture holds both views; expected it with one video of both, or "
        "with --left alone");
  return files;
}

RecordingFiles recording_of(const NewSceneOptions& options) {
  RecordingFiles files = views_of(options);
  if (!options.calibration.empty()) {
    files.calibration = options.calibration;
    files.extrinsics = options.extrinsics;
    if (files.extrinsics.empty()) add_extrinsics(files);
  }
  if (files.calibration.empty())
    ask({.option = "--calibration", .text = "the calibration file of the cameras"},
        [&](const std::string& answer) {
          if (!std::filesystem::is_regular_file(typed_path(answer)))
            throw DataError(answer + ": there is no such file");
          files.calibration = typed_path(answer);
          add_extrinsics(files);
        });
  return files;
}

/// Takes a word from an option or asks for it.
std::string word_of(const Question& question, const std::string& given,
                    const std::vector<std::string>& words) {
  std::string out = given;
  if (out.empty())
    ask({question.option, fmt::format("{} ({})", question.text, fmt::join(words, ", ")),
         question.usual},
        [&](const std::string& answer) {
          expect_one_of(words, answer);
          out = answer;
        });
  return out;
}

SceneRequest request_of(const NewSceneOptions& options) {
  SceneRequest request;
  request.recording = recording_of(options);
  request.cameras = options.cameras;
  request.units = options.units;
  if (options.scale) request.scale = std::stod(*options.scale);
  request.model = word_of({"--model", "what to track", "hand"}, options.model, model_words());
  const bool box = request.model == "hand_and_box" || request.model == "box";
  if (!box && !options.box.empty())
    throw ConfigError(fmt::format(
        "--box: found with --model {}, expected --model hand_and_box or box", request.model));
  if (box) {
    const auto take = [&](const std::string& text) { request.box_mm = box_size_mm(text); };
    if (options.box.empty())
      ask({.option = "--box", .text = "the edges of the box, such as 60x120x30mm"}, take);
    else
      take(options.box);
  }
  const bool one_hand = request.model == "hand" || request.model == "left_hand";
  const std::string usual = request.model == "box"               ? "rigid"
                            : request.recording.live && one_hand ? "real_time"
                                                                 : "real";
  request.tracker =
      word_of({"--tracker", "which tracker", usual}, options.tracker, tracker_words());
  return request;
}

/// A file beside its final place, which is removed unless it gets there.
class PartialFile {
 public:
  PartialFile(const std::filesystem::path& file, const std::string& text)
      : file_(file), partial_(file.string() + fmt::format(".{}.new.yaml", ::getpid())) {
    try {
      write_whole(partial_, text);
    } catch (const OutputError&) {
      fail("check that its folder is writable and has space");
    }
  }
  ~PartialFile() {
    std::error_code ignored;
    std::filesystem::remove(partial_, ignored);
  }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  const std::filesystem::path& path() const { return partial_; }
  /// Moves it to its place. Throws OutputError.
  void finish() {
    std::error_code error;
    std::filesystem::rename(partial_, file_, error);
    if (error) fail(error.message());
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw OutputError(fmt::format("{}: cannot be written; {}", file_.string(), reason));
  }

  std::filesystem::path file_, partial_;
};

/// Returns a message with the final name of the file in place of the partial one.
std::string named(std::string message, const std::filesystem::path& partial,
                  const std::filesystem::path& file) {
  const std::string from = partial.string(), to = file.string();
  for (std::size_t at = 0; (at = message.find(from, at)) != std::string::npos; at += to.size())
    message.replace(at, from.size(), to);
  return message;
}

/// Checks a scene that is not in its place yet. Its first pair must be usable.
CheckedScene check_new(const std::filesystem::path& partial, const std::filesystem::path& file,
                       const CommonOptions& common) try {
  PluginLoader plugins(common.plugin_path);
  CheckedScene scene = check_scene(partial, {}, plugins);
  if (!scene.problem.empty())
    throw DataError(fmt::format("the first pair cannot be used: {}", scene.problem));
  return scene;
} catch (const Error& e) {
  throw ConfigError(
      fmt::format("{}\n{} was not written", named(e.what(), partial, file), file.string()));
}

/// Quotes a file name for a shell if it has to be.
std::string shell_word(const std::string& text) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-+,@%:";
  if (text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// Throws OutputError if the file cannot or may not be written.
void expect_free(const std::filesystem::path& file, bool force) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!std::filesystem::is_directory(folder))
    throw OutputError(
        fmt::format("{}: there is no such folder for {}; make it, or name another file",
                    folder.string(), file.filename().string()));
  if (std::filesystem::is_directory(file))
    throw OutputError(
        fmt::format("{}: is a folder; expected the name of a new scene file", file.string()));
  if (std::filesystem::exists(file) && !std::filesystem::is_regular_file(file))
    throw OutputError(fmt::format("{}: is a device or pipe; expected the name of a new scene file",
                                  file.string()));
  if (std::filesystem::exists(file) && !force)
    throw OutputError(fmt::format(
        "{}: is there already; give --force to replace it, or another name", file.string()));
}

int new_scene(const NewSceneOptions& options, const CommonOptions& common) {
  const std::filesystem::path& file = options.file;
  expect_free(file, options.force);
  const SceneRequest request = request_of(options);
  const InterruptGuard interrupt;
  PartialFile partial(file, scene_text(request, file.parent_path()));
  const CheckedScene scene = check_new(partial.path(), file, common);
  if (interrupt.interrupted()) {
    tell("hypotrack: interrupted; nothing was written\n");
    return kInterruptedExitCode;
  }
  partial.finish();
  fmt::print(
      "{}: {} model{}, {} parameters, {}{}\n", file.string(), scene.models,
      scene.models == 1 ? "" : "s", scene.parameters,
      scene.frames ? fmt::format("{} frame{}, ", *scene.frames, *scene.frames == 1 ? "" : "s") : "",
      scene.backend);
  const std::string word = shell_word(file.string());
  const bool live = request.recording.live.has_value();
  fmt::print("next:\n  hypotrack validate {0}\n  hypotrack run {0}{1}\n", word,
             live ? " --out result --web 8080" : "");
  return 0;
}

void add_recording_options(const Command& command, NewSceneOptions& options) {
  command.add("--recording", &options.recording,
              "Folder of pictures or videos, or a video of both views; twice: two videos");
  command.add(
      "--left", &options.views.left,
      "Pictures (left_%04d.png) or video of the left camera, instead of --recording; or the "
      "live camera: a number, /dev/..., a URL or a GStreamer pipeline",
      {.check = file_name(), .excludes = "--recording"});
  command.add("--right", &options.views.right,
              "Pictures or video of the right camera, or the live camera",
              {.check = file_name(), .excludes = "--recording"});
  add_camera_options(command, options.views);
  command.add("--calibration", &options.calibration,
              "Calibration of the cameras (default: calibration.yaml in the recording's folder)",
              {.check = file_name()});
  command.add("--extrinsics", &options.extrinsics,
              "Second file of the calibration (default: extrinsics beside intrinsics)",
              {.check = file_name()});
  command.add("--cameras", &options.cameras,
              "Names of the left and the right camera in a calibration of more",
              {.value_name = "LEFT,RIGHT", .commas = true});
  command.add("--units", &options.units, "Unit of the calibration's translations",
              {.check = one_of({"m", "cm", "mm"})});
  command.add("--scale", &options.scale,
              "Factor on the calibration's translations: the side of a chessboard square",
              {.check = positive_number()});
}

}  // namespace

void add_new_command(const Command& root, CommonOptions& common, int& exit_code) {
  const Command command = root.add_command("new", "Write new files");
  command.need_command();
  auto options = std::make_shared<NewSceneOptions>();
  const Command scene = command.add_command(
      "scene",
      "Write a scene for a recording or live cameras; asks on a terminal for what is not given");
  scene.add("file", &options->file, "Scene file to write (YAML)",
            {.required = true, .check = file_name()});
  add_recording_options(scene, *options);
  scene.add("--model", &options->model, "Models to track", {.check = one_of(model_words())});
  scene.add("--box", &options->box, "Edges of the box: 60x120x30mm");
  scene.add("--tracker", &options->tracker, "Tracker", {.check = one_of(tracker_words())});
  scene.add("--force", &options->force, "Replace the file if it is there");
  scene.on_call([=, &common, &exit_code] { exit_code = new_scene(*options, common); });
}

}  // namespace hypotrack::app
