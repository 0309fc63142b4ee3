#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/installation.hpp"
#include "base/text_file.hpp"
#include "clicking/click_picture.hpp"
#include "clicking/clicker.hpp"
#include "clicking/window.hpp"
#include "commands.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/pose.hpp"
#include "session/opened_scene.hpp"
#include "tell.hpp"

namespace hypotrack::app {
namespace {

struct StartOptions {
  SceneOptions scene;
  int frame = 0;
  double tolerance = 8;
  std::filesystem::path out;
};

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value && *value;
}

/// Returns false if the X display of DISPLAY surely cannot be reached. Qt would abort the program.
bool can_reach_display() {
  using Open = void* (*)(const char*);
  using Close = int (*)(void*);
  void* library = dlopen("libX11.so.6", RTLD_NOW | RTLD_LOCAL);
  if (!library) return true;
  const auto open = reinterpret_cast<Open>(dlsym(library, "XOpenDisplay"));
  const auto close = reinterpret_cast<Close>(dlsym(library, "XCloseDisplay"));
  if (!open || !close) return true;
  void* display = open(nullptr);
  if (display) close(display);
  return display != nullptr;
}

/// Throws DeviceError if no window can be shown.
void check_display() {
  if (is_set("WAYLAND_DISPLAY") || is_set("QT_QPA_PLATFORM")) return;
  const bool has_display = is_set("DISPLAY");
  if (has_display && can_reach_display()) return;
  const std::string what =
      has_display ? fmt::format("the display {} cannot be reached", std::getenv("DISPLAY"))
                  : "neither DISPLAY nor WAYLAND_DISPLAY is set";
  throw DeviceError(fmt::format(
      "there is no display for the window: {}; run this where there is one, or write the clicks by "
      "hand and start with `init: {{from: clicks, file: FILE.yaml}}`",
      what));
}

/// Loads the module that shows windows.
clicking::ShowWindow load_window() {
  const std::filesystem::path file =
      detail::prefix_folder() / HYPOTRACK_LIBDIR / "hypotrack" / "libhypotrack_window.so";
  void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* function = module ? dlsym(module, clicking::kShowWindow) : nullptr;
  if (!function) {
    const char* why = dlerror();
    throw DeviceError(
        fmt::format("windows need {}, which cannot be loaded: {}; install OpenCV's "
                    "highgui (libopencv-highgui)",
                    file.string(), why ? why : "unknown reason"));
  }
  return reinterpret_cast<clicking::ShowWindow>(function);
}

/// Reads a source up to a frame, which must be usable.
Frame frame_at(Source& source, int index) {
  int frames = 0;
  for (; std::optional<Frame> frame = source.next(); ++frames) {
    if (frame->index < index) continue;
    if (!frame->problem.empty())
      throw DataError(fmt::format("frame {} cannot be used: {}; choose another with --frame",
                                  frame->index, frame->problem));
    return *std::move(frame);
  }
  throw DataError(
      fmt::format("--frame {}: the source has {} frames, 0 to {}", index, frames, frames - 1));
}

/// Returns the clicks file that belongs to a pose file: pose.yaml, pose.clicks.yaml.
std::filesystem::path clicks_file(const std::filesystem::path& pose) {
  std::filesystem::path out = pose;
  return out.replace_extension(".clicks" + pose.extension().string());
}

/// Shows the views until the user saves or quits. Returns whether there is something to save.
bool let_click(clicking::Clicker& clicker, const OpenedScene& session, const Frame& frame) {
  const clicking::ShowWindow show_window = load_window();
  const int left_width = session.source->cameras()[0].width;
  Renderer renderer(*session.scene);
  bool save = false;
  clicking::WindowContent content;
  content.title = "hypotrack start";
  content.picture = [&] {
    return draw_clicks(renderer, *session.scene, session.source->cameras(), frame,
                       clicker.drawing());
  };
  content.on_click = [&](cv::Point at) {
    const std::size_t view = at.x < left_width ? 0 : 1;
    const Camera& camera = session.source->cameras()[view];
    const int x = at.x - (view == 0 ? 0 : left_width);
    if (x < camera.width && at.y < camera.height) clicker.click(view, Eigen::Vector2d(x, at.y));
  };
  content.on_key = [&](char key) {
    const clicking::Clicker::Answer answer = clicker.press(key);
    save = answer == clicking::Clicker::Answer::save;
    return answer == clicking::Clicker::Answer::go_on;
  };
  show_window(content);
  return save;
}

int click_start(const StartOptions& options, const CommonOptions& common) {
  if (options.out.extension() != ".yaml" && options.out.extension() != ".yml")
    throw ConfigError(
        fmt::format("--out {}: a pose is written as YAML; expected a name that ends "
                    "in .yaml",
                    options.out.string()));
  expect_writable(options.out);
  check_display();
  PluginLoader plugins(common.plugin_path);
  OpenedScene session = open_source(options.scene.scene, options.scene.set, plugins);
  const Frame frame = frame_at(*session.source, options.frame);
  clicking::Clicker clicker(*session.scene, session.source->cameras(), options.tolerance);
  if (!let_click(clicker, session, frame)) {
    tell("nothing is saved\n");
    return 1;
  }
  const std::filesystem::path clicks = clicks_file(options.out);
  write_whole(clicks, clicks_yaml({clicker.clicks(), frame.index, summaries(frame)}));
  write_whole(options.out,
              pose_yaml(*session.scene, clicker.fit()->state, clicker.complete_models()));
  fmt::print("{}\n{}: init: {{from: clicks, file: {}}}\n{}: init: {{from: file, file: {}}}\n",
             describe(*clicker.fit()), clicks.string(), clicks.string(), options.out.string(),
             options.out.string());
  return 0;
}

}  // namespace

void add_start_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<StartOptions>();
  const Command command =
      root.add_command("start", "Click landmarks in both views to get a start pose");
  add_scene_options(command, options->scene);
  command.add("--frame", &options->frame, "Frame to show",
              {.show_default = true, .check = whole_number(0)});
  command.add("--tolerance", &options->tolerance,
              "Pixels that a click may be from the epipolar line",
              {.show_default = true, .check = positive_number()});
  command.add("--out", &options->out, "Pose file to write; the clicks go beside it",
              {.required = true, .check = file_name(), .value_name = "POSE.yaml"});
  command.on_call([=, &common, &exit_code] { exit_code = click_start(*options, common); });
}

}  // namespace hypotrack::app
