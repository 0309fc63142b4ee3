#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/text_file.hpp"
#include "clicking/clicker.hpp"
#include "commands.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/pose.hpp"
#include "messages.hpp"
#include "plugin/plugin_notes.hpp"
#include "session/opened_scene.hpp"
#include "window/window.hpp"

namespace hypotrack::app {
namespace {

struct ClickOptions {
  SceneOptions scene;
  int frame = 0;
  double tolerance = 8;
  std::filesystem::path out;
};

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
  const ShowWindow show_window = load_window();
  const int left_width = session.source->cameras()[0].width;
  Renderer renderer(*session.scene);
  bool save = false;
  WindowContent content;
  content.title = "hypotrack click";
  content.picture = [&](cv::Size /*area*/) {
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
    return answer == clicking::Clicker::Answer::go_on ? WindowStep::redraw : WindowStep::close;
  };
  show_window(content);
  return save;
}

int click_pose(const ClickOptions& options, const CommonOptions& common) {
  if (options.out.extension() != ".yaml" && options.out.extension() != ".yml")
    throw ConfigError(
        fmt::format("--out {}: a pose is written as YAML; expected a name that ends "
                    "in .yaml",
                    options.out.string()));
  expect_writable(options.out);
  check_display("write the clicks by hand and start with `init: {from: clicks, file: FILE.yaml}`");
  PluginLoader plugins(common.plugin_path);
  OpenedScene session = open_source(options.scene.scene, options.scene.set, plugins);
  for (const std::string& line : session.plugin_notes->take_lines()) tell("{}\n", line);
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

void add_click_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<ClickOptions>();
  const Command command =
      root.add_command("click", "Click landmarks in both views to get a start pose");
  add_scene_options(command, options->scene);
  command.add("--frame", &options->frame, "Frame to show",
              {.show_default = true, .check = whole_number(0)});
  command.add("--tolerance", &options->tolerance,
              "Pixels that a click may be from the epipolar line",
              {.show_default = true, .check = positive_number()});
  command.add("--out", &options->out, "Pose file to write; the clicks go beside it",
              {.required = true, .check = file_name(), .value_name = "POSE.yaml"});
  command.on_call([=, &common, &exit_code] { exit_code = click_pose(*options, common); });
}

}  // namespace hypotrack::app
