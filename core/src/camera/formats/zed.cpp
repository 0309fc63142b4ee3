#include <Eigen/Geometry>
#include <string>

#include "camera/calibration_text.hpp"
#include "camera/camera_fields.hpp"
#include "camera/formats/formats.hpp"
#include "camera/formats/zed_sections.hpp"

namespace hypotrack::calibration::internal {
namespace {

constexpr std::size_t kPlainCoefficients = 5;
constexpr std::array<std::string_view, 4> kFisheye = {"k1", "k2", "k3", "k4"};
constexpr std::array<std::string_view, 4> kNotFisheye = {"p1", "p2", "k5", "k6"};

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

/// Returns the angle of a key for one resolution. Where only other resolutions have it, it is
/// theirs: the cameras stand to each other as they do.
double angle_for(const ConfigNode& section, std::string_view key, const Resolution& size,
                 std::vector<std::string>& notes) {
  if (section.get(fmt::format("{}_{}", key, size.name)).defined() || section.get(key).defined())
    return number_for(section, key, size);
  for (const Resolution& other : kResolutions) {
    const std::string name = fmt::format("{}_{}", key, other.name);
    if (section.get(name).defined()) return number_of(section, name);
  }
  notes.push_back(
      fmt::format("{}: has no {}_{}; 0 is taken for it", section.where(), key, size.name));
  return 0;
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

/// Reads OpenCV's 5, 8 or 12 coefficients. Sections for one size may leave out p1, p2 and k3.
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
  camera.distortion.resize(kCoefficients.size());
  for (const std::string_view key : kThinPrism) camera.distortion.push_back(number_of(node, key));
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
  if (const auto found = found_in(of_all.node, kCoefficients); !found.empty()) {
    const bool only_fisheye =
        std::ranges::is_permutation(found, kFisheye) && found_in(of_all.node, kThinPrism).empty();
    if (settings.model == DistortionModel::fisheye || (!settings.model && only_fisheye))
      return read_fisheye(of_all, camera);
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
Eigen::Isometry3d right_from_left(const ConfigNode& pair, const Resolution& size, double metres,
                                  std::vector<std::string>& notes) {
  const Eigen::Vector3d turn(angle_for(pair, "RX", size, notes), angle_for(pair, "CV", size, notes),
                             angle_for(pair, "RZ", size, notes));
  const Eigen::Vector3d t(-number_of(pair, "Baseline"), number_for(pair, "TY", size),
                          number_for(pair, "TZ", size));
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  if (turn.norm() > 0) out.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).matrix();
  out.translation() = metres * t;
  return out;
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
    out[1].camera.camera_from_world = right_from_left(
        file.get("STEREO"), size, metres_per_unit(file, settings, LengthUnit::mm), notes);
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
