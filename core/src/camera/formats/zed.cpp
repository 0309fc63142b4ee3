#include <Eigen/Geometry>
#include <iterator>
#include <span>
#include <string>

#include "camera/calibration_text.hpp"
#include "camera/camera_fields.hpp"
#include "camera/formats/formats.hpp"

namespace hypotrack::calibration::internal {
namespace {

/// A resolution of a ZED's pictures.
struct Resolution {
  std::string_view name;
  int width, height;
};
constexpr std::array<Resolution, 8> kResolutions = {{{"2K", 2208, 1242},
                                                     {"FHD", 1920, 1080},
                                                     {"FHD1200", 1920, 1200},
                                                     {"HD", 1280, 720},
                                                     {"SVGA", 960, 600},
                                                     {"VGA", 672, 376},
                                                     {"4k", 3840, 2160},
                                                     {"QHDPLUS", 3200, 1800}}};

using Keys = std::span<const std::string_view>;
constexpr std::array<std::string_view, 4> kPinhole = {"fx", "fy", "cx", "cy"};
/// In OpenCV's order. The last three are those of the rational model.
constexpr std::array<std::string_view, 8> kCoefficients = {"k1", "k2", "p1", "p2",
                                                           "k3", "k4", "k5", "k6"};
constexpr std::size_t kPlainCoefficients = 5;
constexpr std::array<std::string_view, 4> kThinPrism = {"s1", "s2", "s3", "s4"};
constexpr std::array<std::string_view, 4> kFisheye = {"k1", "k2", "k3", "k4"};
constexpr std::array<std::string_view, 4> kNotFisheye = {"p1", "p2", "k5", "k6"};

bool is_one_of(std::string_view key, Keys keys) {
  return std::ranges::find(keys, key) != keys.end();
}

/// Returns those of some keys that a section has.
std::vector<std::string_view> found_in(const ConfigNode& section, Keys keys) {
  std::vector<std::string_view> out;
  std::ranges::copy_if(keys, std::back_inserter(out),
                       [&](std::string_view key) { return section.get(key).defined(); });
  return out;
}

double number_of(const ConfigNode& section, std::string_view key) {
  const ConfigNode node = section.get(key);
  if (!node.defined()) {
    throw DataError(
        fmt::format("{}: has no {}; expected a ZED's factory calibration", section.where(), key));
  }
  return read_number(node, key);
}

/// Returns the number of a key for one resolution, or else that of the key, or else 0.
double number_for(const ConfigNode& section, std::string_view key, const Resolution& size) {
  const std::string own = fmt::format("{}_{}", key, size.name);
  if (section.get(own).defined()) return number_of(section, own);
  return section.get(key).defined() ? number_of(section, key) : 0;
}

/// Returns whether all of some keys that a section has are 0.
bool are_zero(const ConfigNode& section, Keys keys) {
  return std::ranges::all_of(found_in(section, keys), [&](std::string_view key) {
    return read_number(section.get(key), key) == 0;
  });
}

/// A section with coefficients of a lens.
struct LensSection {
  std::string name;
  ConfigNode node;
  bool of_all_sizes = false;  ///< as newer files have it
};

/// Reads OpenCV's 5 or 8 coefficients. Sections for one size may leave out p1, p2 and k3.
void read_brown(const LensSection& section, Camera& camera) {
  const ConfigNode& node = section.node;
  const bool rational = !found_in(node, Keys(kCoefficients).subspan(kPlainCoefficients)).empty();
  const Keys wanted =
      Keys(kCoefficients).first(rational ? kCoefficients.size() : kPlainCoefficients);
  camera.distortion_model = DistortionModel::brown;
  for (const std::string_view key : wanted) {
    const bool optional = !section.of_all_sizes && !rational && key != "k1" && key != "k2";
    if (!node.get(key).defined() && !optional) {
      throw DataError(
          fmt::format("{}: [{}] has {} and no {}; expected {}{}", node.where(), section.name,
                      fmt::join(found_in(node, kCoefficients), ", "), key, fmt::join(wanted, ", "),
                      section.of_all_sizes ? ", or k1, k2, k3, k4 with `model: fisheye`" : ""));
    }
    camera.distortion.push_back(node.get(key).defined() ? number_of(node, key) : 0);
  }
  if (are_zero(node, kThinPrism)) return;
  throw DataError(
      fmt::format("{}: [{}] has s1 to s4 that are not 0: the thin-prism model is not supported; "
                  "calibrate with `hypotrack calibrate`, or with 5 or 8 coefficients",
                  node.where(), section.name));
}

void read_fisheye(const LensSection& section, Camera& camera) {
  if (!are_zero(section.node, kNotFisheye)) {
    throw DataError(
        fmt::format("{}: [{}] has p1, p2, k5 or k6 that is not 0, which no fisheye lens has; leave "
                    "`model: fisheye` out",
                    section.node.where(), section.name));
  }
  camera.distortion_model = DistortionModel::fisheye;
  for (const std::string_view key : kFisheye)
    camera.distortion.push_back(number_of(section.node, key));
}

/// Reads the lens of one camera. Newer files have it once for all sizes, in LEFT_DISTO, with more
/// coefficients than in a section for one size, which they keep for older programs.
void read_zed_lens(const LensSection& of_all, const LensSection& of_one,
                   const CalibrationSettings& settings, Camera& camera,
                   std::vector<std::string>& notes) {
  if (!found_in(of_all.node, kCoefficients).empty()) {
    if (settings.model == DistortionModel::fisheye) return read_fisheye(of_all, camera);
    read_brown(of_all, camera);
    const bool has_k4 = of_all.node.get("k4").defined() && number_of(of_all.node, "k4") != 0;
    if (!settings.model && has_k4 && are_zero(of_all.node, kNotFisheye)) {
      notes.push_back(
          fmt::format("{}: p1, p2, k5 and k6 of [{}] are 0, as in files of fisheye lenses; if this "
                      "is one, write `model: fisheye`",
                      of_all.node.where(), of_all.name));
    }
    return;
  }
  if (!found_in(of_one.node, kCoefficients).empty()) return read_brown(of_one, camera);
  throw DataError(fmt::format(
      "{}: no lens: [{}] has {}, and there is {} [{}]; expected k1, k2, p1, p2, k3 (k4, k5, k6) in "
      "one of them. Fetch the camera's file again, or calibrate with `hypotrack calibrate`",
      of_one.node.where(), of_one.name, fmt::join(of_one.node.keys(), ", "),
      of_all.node.defined() ? "no coefficient in" : "no", of_all.name));
}

Camera read_zed_camera(const ConfigNode& file, std::string_view side, const Resolution& size,
                       const CalibrationSettings& settings, std::vector<std::string>& notes) {
  LensSection of_all{fmt::format("{}_DISTO", side), {}, true};
  LensSection of_one{fmt::format("{}_CAM_{}", side, size.name), {}, false};
  of_all.node = file.get(of_all.name);
  of_one.node = file.get(of_one.name);
  Camera camera;
  camera.width = size.width;
  camera.height = size.height;
  camera.fx = number_of(of_one.node, "fx");
  camera.fy = number_of(of_one.node, "fy");
  camera.cx = number_of(of_one.node, "cx");
  camera.cy = number_of(of_one.node, "cy");
  read_zed_lens(of_all, of_one, settings, camera, notes);
  return camera;
}

/// Returns the pose of the right camera, p_right = R p_left + T. R is a turn about (RX, CV, RZ) by
/// that vector's length, as Rodrigues' formula takes it. T is (-Baseline, TY, TZ): the maker's
/// calibration tool writes the first component without its sign, and the others as they are.
Eigen::Isometry3d right_from_left(const ConfigNode& pair, const Resolution& size, double metres) {
  const Eigen::Vector3d turn(number_for(pair, "RX", size), number_for(pair, "CV", size),
                             number_for(pair, "RZ", size));
  const Eigen::Vector3d t(-number_of(pair, "Baseline"), number_for(pair, "TY", size),
                          number_for(pair, "TZ", size));
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  if (turn.norm() > 0) out.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).matrix();
  out.translation() = metres * t;
  return out;
}

/// What of a file is not used: names of sections, and of keys as `[SECTION] key`.
struct Unused {
  std::vector<std::string> other_sizes, older_lenses, unknown;
};

bool is_resolution(std::string_view name) {
  return std::ranges::any_of(kResolutions, [&](const auto& size) { return size.name == name; });
}

/// Returns whether a key is of the pose, for all resolutions or for one: RX, RX_HD.
bool is_of_the_pose(std::string_view key) {
  constexpr std::array<std::string_view, 5> kPose = {"TY", "TZ", "CV", "RX", "RZ"};
  const std::size_t mark = key.find('_');
  return key == "Baseline" ||
         (is_one_of(key.substr(0, mark), kPose) &&
          (mark == std::string_view::npos || is_resolution(key.substr(mark + 1))));
}

/// Returns the resolution of LEFT_CAM_HD; empty for other names.
std::string_view resolution_in(std::string_view name) {
  for (const std::string_view before : {"LEFT_CAM_", "RIGHT_CAM_"})
    if (name.starts_with(before) && is_resolution(name.substr(before.size())))
      return name.substr(before.size());
  return {};
}

void look_for_unused(const ConfigNode& file, const std::string& name, const Resolution& size,
                     Unused& unused) {
  const ConfigNode section = file.get(name);
  const std::string_view resolution = resolution_in(name);
  const bool of_all_sizes = name == "LEFT_DISTO" || name == "RIGHT_DISTO";
  if (name == "units") return;
  if (!section.is_map() ||
      (resolution.empty() && !of_all_sizes && name != "STEREO" && name != "MISC"))
    return unused.unknown.push_back(fmt::format("[{}]", name));
  if (!resolution.empty() && resolution != size.name)
    return unused.other_sizes.push_back(fmt::format("[{}]", name));
  const auto is_known = [&](std::string_view key) {
    if (of_all_sizes) return is_one_of(key, kCoefficients) || is_one_of(key, kThinPrism);
    if (name == "STEREO") return is_of_the_pose(key);
    if (name == "MISC") return key == "Sensor_ID";  // says nothing of the pictures
    return is_one_of(key, kPinhole) || is_one_of(key, kCoefficients);
  };
  for (const std::string& key : section.keys())
    if (!is_known(key)) unused.unknown.push_back(fmt::format("[{}] {}", name, key));
  const std::string all_sizes = fmt::format("{}_DISTO", name.substr(0, name.find('_')));
  if (!resolution.empty() && !found_in(section, kCoefficients).empty() &&
      !found_in(file.get(all_sizes), kCoefficients).empty())
    unused.older_lenses.push_back(fmt::format("[{}]", name));
}

/// Adds one note on everything in a file that is not used.
void note_unused_sections(const ConfigNode& file, const Resolution& size,
                          const std::string& file_name, std::vector<std::string>& notes) {
  Unused unused;
  for (const std::string& name : file.keys()) look_for_unused(file, name, size, unused);
  std::vector<std::string> parts;
  const auto add = [&](const std::vector<std::string>& names, std::string_view why) {
    if (!names.empty()) parts.push_back(fmt::format("{} ({})", fmt::join(names, ", "), why));
  };
  add(unused.unknown, "not understood");
  add(unused.other_sizes, "for pictures of other sizes");
  add(unused.older_lenses, "the coefficients there: those for all sizes are newer");
  if (!parts.empty())
    notes.push_back(fmt::format("{}: not used: {}", file_name, fmt::join(parts, "; ")));
}

}  // namespace

bool is_zed(const ConfigNode& file) {
  return file.get("STEREO").is_map() && std::ranges::any_of(kResolutions, [&](const auto& size) {
           return file.get(fmt::format("LEFT_CAM_{}", size.name)).is_map();
         });
}

std::vector<NamedCamera> read_zed(const ConfigNode& file, const CalibrationSettings& settings,
                                  const ImageSize& pictures, std::vector<std::string>& notes) {
  std::string known;
  for (const Resolution& size : kResolutions) {
    const ConfigNode left = file.get(fmt::format("LEFT_CAM_{}", size.name));
    const ConfigNode right = file.get(fmt::format("RIGHT_CAM_{}", size.name));
    if (!left.is_map() || !right.is_map()) continue;
    known += fmt::format("{}{} x {}", known.empty() ? "" : ", ", size.width, size.height);
    if (size.width != pictures.width || size.height != pictures.height) continue;
    std::vector<NamedCamera> out{{"left", read_zed_camera(file, "LEFT", size, settings, notes)},
                                 {"right", read_zed_camera(file, "RIGHT", size, settings, notes)}};
    out[1].camera.camera_from_world =
        right_from_left(file.get("STEREO"), size, metres_per_unit(file, settings, LengthUnit::mm));
    note_unused_sections(file, size, settings.file.string(), notes);
    return out;
  }
  if (pictures.width == 0) {
    throw DataError(
        fmt::format("{}: has cameras for pictures of {}; choose one with `image_size: [width, "
                    "height]`",
                    settings.file.string(), known));
  }
  throw DataError(fmt::format("{}: has no cameras for pictures of {} x {}; expected {}",
                              settings.file.string(), pictures.width, pictures.height, known));
}

}  // namespace hypotrack::calibration::internal
