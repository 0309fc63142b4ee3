#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "commands.hpp"
#include "hypotrack/api/stop.hpp"
#include "interrupt.hpp"
#include "lab/landscape/landscape_files.hpp"
#include "lab/landscape/landscape_frame.hpp"
#include "messages.hpp"

namespace hypotrack::app {
namespace {

struct LandscapeOptions {
  SceneOptions scene;
  int frame = 0;
  std::filesystem::path out = "landscape";
  int points = 41, grid = 15;
  bool all_pairs = false;
};

/// Returns along how many parameters the centre is the lowest point of its slice.
std::ptrdiff_t lowest_at_centre(const Landscape& landscape) {
  return std::ranges::count_if(landscape.lines, [&](const LandscapeSlice& slice) {
    return landscape.centre[0] <= slice.costs.col(0).minCoeff();
  });
}

int landscape(const LandscapeOptions& options, const CommonOptions& common) {
  PluginLoader plugins(common.plugin_path);
  const InterruptGuard interrupt;
  LandscapeRequest request{.scene = options.scene.scene,
                           .overrides = options.scene.set,
                           .frame = options.frame,
                           .settings = {}};
  request.settings.points = options.points;
  request.settings.grid = options.grid;
  request.settings.all_pairs = options.all_pairs;
  try {
    const FrameLandscape found =
        landscape_of_frame(request, plugins, [&] { return interrupt.interrupted(); });
    const char* centre = found.around_truth ? "the truth" : "the tracked pose";
    write_landscape(found.landscape,
                    fmt::format("Cost of frame {} around {}", options.frame, centre), options.out);
    fmt::print("frame {}: cost {:.6g} at {}, the lowest of {} of {} slices; results in {}\n",
               options.frame, found.landscape.centre[0], centre, lowest_at_centre(found.landscape),
               found.landscape.lines.size(), options.out.string());
    return 0;
  } catch (const Stopped&) {
    tell("hypotrack: interrupted; nothing was written\n");
    return kInterruptedExitCode;
  }
}

}  // namespace

void add_landscape_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<LandscapeOptions>();
  const Command command =
      root.add_command("landscape", "Draw slices of the cost around the true or tracked pose");
  add_scene_options(command, options->scene);
  command.add("--frame", &options->frame, "Number of the frame",
              {.show_default = true, .check = whole_number(0)});
  command.add("--out", &options->out, "Folder for figures and tables",
              {.show_default = true, .check = file_name()});
  command.add("--points", &options->points, "Points along a parameter",
              {.show_default = true, .check = whole_number(3, 1001)});
  command.add("--grid", &options->grid, "Points along each side of a pair of parameters",
              {.show_default = true, .check = whole_number(3, 201)});
  command.add("--all-pairs", &options->all_pairs,
              "Also pairs of different limbs and models (default: of one pose or limb)");
  command.on_call([=, &common, &exit_code] { exit_code = landscape(*options, common); });
}

}  // namespace hypotrack::app
