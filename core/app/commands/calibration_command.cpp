#include <fmt/format.h>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "boards/calibration_output.hpp"
#include "cameras/camera_options.hpp"
#include "commands.hpp"
#include "hypotrack/api/error.hpp"
#include "messages.hpp"

namespace hypotrack::app {
namespace {

struct CalibrationOptions {
  CalibrationSettings settings;
  std::optional<std::string> units, model, image_size;
  double scale = 1;
  std::filesystem::path out;
  bool force = false;
  std::string left, right;
  std::optional<std::string> layout;
  std::optional<int> bits;
  ColorOptions colors;
  BoardOptions board;
};

/// Returns the settings with what the options say in words.
CalibrationSettings settings_of(const CalibrationOptions& options) {
  CalibrationSettings out = options.settings;
  out.scale = options.scale;
  if (options.units) out.units = value_named<LengthUnit>(options.units);
  if (options.model) out.model = value_named<DistortionModel>(options.model);
  if (options.image_size) {
    int width = 0, height = 0;
    char rest = 0;
    if (std::sscanf(options.image_size->c_str(), "%dx%d%c", &width, &height, &rest) != 2) {
      throw ConfigError(fmt::format("--image-size is '{}'; expected width and height, as 1280x720",
                                    *options.image_size));
    }
    out.image_size = {static_cast<double>(width), static_cast<double>(height)};
  }
  return out;
}

int info(const CalibrationOptions& options) {
  const Calibration found = read_calibration(settings_of(options));
  fmt::print("{}: {}, {} camera{}\n", options.settings.file.string(), found.format,
             found.cameras.size(), found.cameras.size() == 1 ? "" : "s");
  print_cameras(found.cameras);
  for (const std::string& note : found.notes) fmt::print("note: {}\n", note);
  return 0;
}

int convert(const CalibrationOptions& options) {
  check_new_file(options.out, options.force);
  std::vector<std::string> notes;
  const std::vector<Camera> cameras = load_calibration(settings_of(options), {}, &notes);
  for (const std::string& note : notes) tell("note: {}\n", note);
  for (std::size_t i = 0; i < cameras.size(); ++i)
    if (cameras[i].width == 0) {
      throw DataError(fmt::format("{}: does not say how large the pictures are; give --image-size",
                                  options.settings.file.string()));
    }
  write_calibration(options.out, cameras);
  fmt::print("calibration in {}\n", options.out.string());
  return 0;
}

int check(const CalibrationOptions& options) {
  constexpr int kStep = 30;  // frames of a video
  const calibrate::PairFiles files{options.left, options.right,
                                   kStep,        value_named<StereoLayout>(options.layout),
                                   options.bits, options.colors.colors()};
  if (files.layout ? !files.right.empty() : files.right.empty())
    throw ConfigError("expected --left and --right, or --left with --layout");
  return check_calibration(settings_of(options), files, options.board);
}

void add_file_options(const Command& command, CalibrationOptions& options) {
  command.add(
      "file", &options.settings.file,
      "Calibration of hypotrack, OpenCV, Kalibr, ROS, ZED, depthai, ORB-SLAM, EuRoC, caliscope or "
      "anipose",
      {.required = true});
  command.add("--second", &options.settings.second, "File of the second camera, as ROS has");
  command.add("--extrinsics", &options.settings.extrinsics,
              "File with R and T, as OpenCV's stereo_calib writes");
  command.add("--cameras", &options.settings.cameras, "Names of the cameras to take, in order",
              {.commas = true});
  command.add("--units", &options.units, "Unit of the translations, where the file does not say",
              {.check = one_of({"m", "cm", "mm"})});
  command.add("--scale", &options.scale, "Further factor on the translations",
              {.check = positive_number()});
  command.add("--model", &options.model, "Lens model, where the file does not say",
              {.check = one_of({"none", "brown", "fisheye"})});
  command.add("--image-size", &options.image_size, "Size of the pictures",
              {.value_name = "1280x720"});
  command.add("--any-baseline", &options.settings.any_baseline,
              "Accept cameras less than 5 mm or more than 2 m apart");
}

}  // namespace

void add_calibration_command(const Command& root, int& exit_code) {
  const Command command = root.add_command("calibration", "Look at calibration files");
  command.need_command();

  auto of_info = std::make_shared<CalibrationOptions>();
  const Command info_command = command.add_command("info", "Print the cameras of a file");
  add_file_options(info_command, *of_info);
  info_command.on_call([=, &exit_code] { exit_code = info(*of_info); });

  auto of_convert = std::make_shared<CalibrationOptions>();
  const Command convert_command =
      command.add_command("convert", "Write the cameras of a file in hypotrack's form");
  add_file_options(convert_command, *of_convert);
  convert_command.add("--out", &of_convert->out, "File to write",
                      {.required = true, .check = file_name()});
  convert_command.add("--force", &of_convert->force, "Replace the file");
  convert_command.on_call([=, &exit_code] { exit_code = convert(*of_convert); });

  auto of_check = std::make_shared<CalibrationOptions>();
  const Command check_command = command.add_command(
      "check", "Compare pictures with a file: epipolar lines, exchanged views, a board's size");
  add_file_options(check_command, *of_check);
  check_command.add("--left", &of_check->left, "Pictures of the first camera, or a video",
                    {.required = true, .value_name = "'left*.jpg'"});
  check_command.add("--right", &of_check->right, "Pictures of the second camera",
                    {.value_name = "'right*.jpg'"});
  add_layout_option(check_command, of_check->layout);
  check_command.add("--bits", &of_check->bits,
                    "Significant bits of 16-bit pictures, for example 12 (default: 16)",
                    {.check = whole_number(8, 16)});
  add_color_options(check_command, of_check->colors);
  add_board_options(check_command, of_check->board, false);
  check_command.on_call([=, &exit_code] { exit_code = check(*of_check); });
}

}  // namespace hypotrack::app
