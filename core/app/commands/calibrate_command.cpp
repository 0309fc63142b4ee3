#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "base/text_file.hpp"
#include "boards/board_options.hpp"
#include "boards/board_pictures.hpp"
#include "boards/calibration_output.hpp"
#include "calibrate/board/board.hpp"
#include "calibrate/check/coverage.hpp"
#include "calibrate/stereo_calibration.hpp"
#include "cameras/camera_options.hpp"
#include "commands.hpp"
#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "interrupt.hpp"
#include "live_pairs/take_pairs.hpp"
#include "messages.hpp"

namespace hypotrack::app {
namespace {

struct CalibrateOptions {
  CameraOptions views;
  ColorOptions colors;
  BoardOptions board;
  bool force = false;
  int step = 1;
  std::optional<int> bits;
  std::optional<std::filesystem::path> lenses, coverage;
  std::vector<std::string> cameras;
  std::filesystem::path out = "calibration.yaml";
  std::optional<std::filesystem::path> pairs;
  std::optional<std::string> seconds;

  /// Returns whether live cameras are given. Throws ConfigError if none and no pictures are.
  bool live() const {
    const bool found = names_cameras(views);
    if (!found && (views.left.empty() || (views.right.empty() && !views.layout)))
      throw ConfigError(
          "there is nothing to calibrate from; expected --left and --right, or --device");
    if (!found && (pairs || seconds))
      throw ConfigError(
          "--pairs and --seconds belong to live cameras; expected --device, or cameras as --left "
          "and --right");
    return found;
  }
};

/// Returns the folder for pairs of live cameras: calibration_pairs beside calibration.yaml.
std::filesystem::path pairs_folder(const CalibrateOptions& options) {
  if (options.pairs) return *options.pairs;
  return options.out.parent_path() / (options.out.stem().string() + "_pairs");
}

/// Returns the command that calibrates again from pairs that were taken.
std::string repeating_command(const CalibrateOptions& options, const PairFolder& folder) {
  return fmt::format("hypotrack calibrate --left '{}' --right '{}' {}", folder.pattern("left"),
                     folder.pattern("right"), words_of(options.board));
}

/// Takes pairs of live cameras.
FoundBoards take_boards(const calibrate::BoardFinder& finder, const CalibrateOptions& options,
                        const CommonOptions& common) {
  detail::YamlDocument yaml = camera_source(options.views);
  yaml.set_plain("uncalibrated", "true");
  yaml.set_plain("timeout_s", "1");  // what Ctrl-C and Enter may wait
  PluginLoader plugins(common.plugin_path);
  const auto source =
      plugins.make<Source>(ConfigNode::parse(yaml.text(), "the cameras of the command line"));
  for (const std::string& note : source->notes()) tell("note: {}\n", note);
  const InterruptGuard interrupt;
  PairFolder folder(pairs_folder(options));
  std::optional<double> seconds;
  if (options.seconds) seconds = std::stod(*options.seconds);
  const auto say_where = [&] {
    if (folder.empty()) return;
    tell("the pairs are in {}; to calibrate from them:\n  {}\n", folder.path().string(),
         repeating_command(options, folder));
  };
  TakenPairs taken;
  try {
    taken = take_pairs(finder, *source, folder, seconds, interrupt);
  } catch (const DataError&) {  // the cameras are gone
    say_where();
    throw;
  }
  say_where();
  return {
      std::move(taken.pairs), {}, {}, taken.picture, taken.interrupted && folder.empty(), {}, {}};
}

/// Reads the lenses of both cameras.
std::optional<std::array<Camera, 2>> lenses_of(const CalibrateOptions& options, cv::Size size) {
  if (!options.lenses) return std::nullopt;
  CalibrationSettings settings;
  settings.file = *options.lenses;
  settings.cameras = options.cameras;
  settings.any_baseline = true;
  std::vector<std::string> notes;
  std::vector<Camera> cameras = load_calibration(settings, {size.width, size.height}, &notes);
  for (const std::string& note : notes) tell("note: {}\n", note);
  if (cameras.size() != 2) {
    throw DataError(
        fmt::format("{}: has {} cameras; expected the two of the pictures, which --cameras chooses",
                    options.lenses->string(), cameras.size()));
  }
  for (Camera& camera : cameras) {
    fit_image_size(camera, size.width, size.height, "the pictures");
    if (camera.distortion_model != DistortionModel::fisheye) continue;
    throw DataError(
        fmt::format("{}: has a fisheye lens; expected the model brown", options.lenses->string()));
  }
  return std::array{cameras[0], cameras[1]};
}

void print_pairs(const calibrate::StereoCalibration& found) {
  std::size_t width = 4;
  for (const auto& pair : found.pairs) width = std::max(width, pair.name.size());
  fmt::print(
      "{:{}}   left px  right px  sharp px   (root mean square distance of the corners; of corners "
      "as sharp as these)\n",
      "pair", width);
  for (const auto& pair : found.pairs)
    if (pair.too_few)
      fmt::print("{:{}}         -         -         -   too few corners that both show\n",
                 pair.name, width);
    else
      fmt::print("{:{}}  {:8.3f}  {:8.3f}  {:8.3f}{}\n", pair.name, width, pair.rms[0], pair.rms[1],
                 pair.expected,
                 pair.exchanged ? "   dropped: left and right seem exchanged"
                 : pair.dropped ? "   dropped: far worse than the others"
                                : "");
}

void print_some(const std::vector<std::string>& names, const char* what) {
  constexpr std::ptrdiff_t kMost = 6;
  if (names.empty()) return;
  const auto shown = std::min(kMost, std::ssize(names));
  fmt::print("{} pairs {}: {}{}\n", names.size(), what,
             fmt::join(names.begin(), names.begin() + shown, ", "),
             shown < std::ssize(names) ? ", ..." : "");
}

int calibrate_pair(const CalibrateOptions& options, const CommonOptions& common) {
  check_new_file(options.out, options.force);
  expect_writable(options.out);
  const bool live = options.live();
  const calibrate::BoardFinder finder(board_of(options.board));
  FoundBoards boards =
      live ? take_boards(finder, options, common)
           : find_boards(finder, {options.views.left, options.views.right, options.step,
                                  layout_of(options.views), options.bits, options.colors.colors()});
  if (boards.interrupted) {
    tell("hypotrack: interrupted before there were enough pairs; nothing was written\n");
    return kInterruptedExitCode;
  }
  const std::string pattern = settle_pattern(finder.board(), boards);
  const auto lenses = lenses_of(options, boards.size);
  expect_board(finder.board(), boards);
  const calibrate::StereoCalibration found =
      calibrate::calibrate_stereo(finder, boards.size, boards.pairs, lenses);
  print_pairs(found);
  print_some(boards.without, "do not show the board in both pictures");
  print_some(boards.repeated, "do not count: the board is where it is in another one");
  if (options.board.marker)
    if (const std::string note = marker_note(finder.board(), boards); !note.empty())
      fmt::print("note: {}\n", note);
  if (!pattern.empty()) fmt::print("{}\n", pattern);
  print_cameras({{"left", found.cameras[0]}, {"right", found.cameras[1]}});
  const calibrate::Verdict verdict = calibrate::verdict_of(boards.pairs, found);
  fmt::print("{}\n", verdict.summary);
  for (const std::string& advice : verdict.advice) fmt::print("- {}\n", advice);
  if (options.coverage &&
      !write_image(options.coverage->string(), calibrate::draw_coverage(boards.pairs, found))) {
    throw OutputError(
        fmt::format("{}: the picture cannot be written; expected a .png in a folder that exists",
                    options.coverage->string()));
  }
  write_calibration(options.out, {found.cameras[0], found.cameras[1]});
  fmt::print("calibration in {}\n", options.out.string());
  return verdict.usable ? 0 : 1;
}

}  // namespace

void add_calibrate_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<CalibrateOptions>();
  const Command command =
      root.add_command("calibrate", "Calibrate two cameras from pictures of a board, or live");
  command.add("--left", &options->views.left,
              "Pictures of the left camera: a pattern in quotes or a video. Or the live camera: a "
              "number, /dev/..., a URL or a GStreamer pipeline",
              {.value_name = "'left*.jpg'"});
  command.add("--right", &options->views.right,
              "Pictures of the right camera, in the same order, or the live camera",
              {.value_name = "'right*.jpg'"});
  add_camera_options(command, options->views);
  add_board_options(command, options->board, true);
  command.add("--step", &options->step, "Use every n-th frame of videos",
              {.show_default = true, .check = whole_number(1)});
  command.add("--bits", &options->bits,
              "Significant bits of 16-bit pictures, for example 12 (default: 16)",
              {.check = whole_number(8, 16)});
  add_color_options(command, options->colors);
  command.add("--lenses", &options->lenses,
              "Calibration file with the lenses of both cameras: find only where they are");
  command.add("--cameras", &options->cameras, "Names of the two cameras in --lenses",
              {.value_name = "LEFT,RIGHT", .commas = true});
  command.add("--out", &options->out, "Calibration file to write",
              {.show_default = true, .check = file_name()});
  command.add("--coverage", &options->coverage, "Picture to write of where corners were seen",
              {.value_name = "FILE.png"});
  command.add("--force", &options->force, "Replace the calibration file");
  command.add(
      "--pairs", &options->pairs,
      "Folder for pairs of live cameras (default: --out with _pairs in place of its ending)",
      {.check = file_name()});
  command.add("--seconds", &options->seconds, "End taking pairs after this time",
              {.check = positive_number()});
  command.on_call([=, &common, &exit_code] { exit_code = calibrate_pair(*options, common); });
}

}  // namespace hypotrack::app
