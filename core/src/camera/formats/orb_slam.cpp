#include <Eigen/Geometry>
#include <string>
#include <utility>

#include "camera/calibration_text.hpp"
#include "camera/camera_fields.hpp"
#include "camera/formats/formats.hpp"
#include "camera/formats/unused_keys.hpp"

namespace hypotrack::calibration::internal {
namespace {

enum class OrbCamera { pinhole, fisheye, rectified };

/// Settings, and which of their keys are used.
struct OrbSettings {
  const ConfigNode& file;
  KeyPaths used;

  ConfigNode optional(const std::string& key) {
    used.push_back(key);
    return file.get(key);
  }
  double number(const std::string& key) {
    const ConfigNode node = optional(key);
    if (!node.defined())
      throw DataError(
          fmt::format("{}: has no {}; expected settings of ORB-SLAM", file.where(), key));
    return read_number(node, key);
  }
};

OrbCamera type_of(OrbSettings& settings) {
  const ConfigNode type = settings.optional("Camera.type");
  if (!type.defined()) return OrbCamera::pinhole;  // as in older files
  constexpr std::array<std::string_view, 3> kTypes = {"PinHole", "KannalaBrandt8", "Rectified"};
  return static_cast<OrbCamera>(index_of(type, "Camera.type", kTypes));
}

/// Reads `Camera1.fx` and so on; `name` is `Camera1`.
Camera read_orb_camera(OrbSettings& settings, const std::string& name, OrbCamera type) {
  Camera camera;
  camera.fx = settings.number(name + ".fx");
  camera.fy = settings.number(name + ".fy");
  camera.cx = settings.number(name + ".cx");
  camera.cy = settings.number(name + ".cy");
  if (settings.optional("Camera.width").defined() || settings.optional("Camera.height").defined()) {
    settings.number("Camera.width");
    settings.number("Camera.height");
    camera.width = read_count(settings.file.get("Camera.width"), "Camera.width");
    camera.height = read_count(settings.file.get("Camera.height"), "Camera.height");
  }
  const auto has = [&](const char* key) { return settings.file.get(name + key).defined(); };
  const auto take = [&](const char* key) {
    camera.distortion.push_back(settings.number(name + key));
  };
  if (type == OrbCamera::fisheye) {
    camera.distortion_model = DistortionModel::fisheye;
    for (const char* key : {".k1", ".k2", ".k3", ".k4"}) take(key);
  } else if (type == OrbCamera::pinhole && (has(".k1") || has(".k2") || has(".p1") || has(".p2"))) {
    camera.distortion_model = DistortionModel::brown;
    for (const char* key : {".k1", ".k2", ".p1", ".p2"}) take(key);
    if (has(".k3")) take(".k3");
  }
  return camera;
}

/// Reads the pose of the second camera in the frame of the first: p_1 = T p_2.
Eigen::Isometry3d read_first_from_second(OrbSettings& settings, double metres) {
  for (const char* key : {"Stereo.T_c1_c2", "Tlr"}) {
    const ConfigNode node = settings.optional(key);
    if (!node.defined()) continue;
    YamlMatrix matrix = read_matrix(node, key);
    if (matrix.rows == 3 && matrix.cols == 4) {
      matrix.rows = 4;
      matrix.values.insert(matrix.values.end(), {0, 0, 0, 1});
    }
    return rigid_transform(matrix, metres);
  }
  throw DataError(
      fmt::format("{}: has Camera2, and no Stereo.T_c1_c2 (or Tlr); expected where the "
                  "second camera stands",
                  settings.file.where()));
}

/// One of LEFT and RIGHT: a camera of pictures that are not rectified yet.
struct RawCamera {
  Camera camera;
  Rectified rectified;
  YamlMatrix projection;
};

RawCamera read_raw(OrbSettings& settings, const std::string& side, double metres) {
  constexpr std::string_view kAdvice = "expected K, D, R, P, width and height of LEFT and RIGHT";
  const auto get = [&](const char* key) {
    const ConfigNode node = settings.optional(side + key);
    if (!node.defined()) {
      throw DataError(
          fmt::format("{}: has no {}{}; {}", settings.file.where(), side, key, kAdvice));
    }
    return node;
  };
  RawCamera out;
  out.camera.width = read_count(get(".width"), side + ".width");
  out.camera.height = read_count(get(".height"), side + ".height");
  read_intrinsics(get(".K"), out.camera);
  read_lens(get(".D"), std::nullopt, out.camera);
  out.projection = read_matrix(get(".P"), side + ".P");
  out.rectified = read_rectified(get(".R"), get(".P"), metres);
  return out;
}

/// Returns whether LEFT and RIGHT lead to the rectified camera of the same file. Programs that do
/// not use them ignore what was copied from another file.
bool agree(const RawCamera& left, const RawCamera& right, const Camera& rectified, double bf) {
  constexpr double kNear = 1e-3;
  const auto near = [](double a, double b) { return std::abs(a - b) <= kNear * std::abs(b); };
  const std::vector<double>& p = left.projection.values;
  return near(p[0], rectified.fx) && near(p[2], rectified.cx) && near(p[6], rectified.cy) &&
         (bf == 0 || near(-right.projection.values[3], bf));
}

/// Adds one note on what of the settings is not used.
void note_unused_settings(OrbSettings& settings, const std::string& file_name,
                          const KnownButUnused& more, std::vector<std::string>& notes) {
  append({"units", "File.version", "Camera.fps", "Camera.RGB", "ThDepth", "Stereo.ThDepth",
          "ORBextractor.*", "Viewer.*", "System.*", "Lapping.*", "Camera.overlapping*",
          "Camera1.overlapping*", "Camera2.overlapping*", "Camera.lapping*", "Camera2.lapping*"},
         settings.used);
  KnownButUnused smaller{"ORB-SLAM makes pictures smaller; expected here as the camera takes them",
                         {}};
  for (const char* key : {"newWidth", "newHeight", "imageScale"}) {
    const std::string name = std::string("Camera.") + key;
    const std::string text = settings.file.get(name).scalar();
    const std::string same =
        settings.file.get(std::string_view(key) == "newWidth" ? "Camera.width" : "Camera.height")
            .scalar();
    (text == same || text == "1.0" ? settings.used : smaller.paths).push_back(name);
  }
  if (settings.file.get("Camera.bFishEye").scalar() == "0")
    settings.used.emplace_back("Camera.bFishEye");
  note_unused_keys(settings.file, file_name, settings.used,
                   {more,
                    smaller,
                    {"of the IMU", {"IMU.*", "Tbc", "InsertKFsWhenLost"}},
                    {"one camera with depth: `depth_factor` of the source rgbd",
                     {"RGBD.DepthMapFactor", "DepthMapFactor"}}},
                   notes);
}

/// Reads the second camera of a file; nothing if there is one camera. May replace the first one by
/// that of pictures that are not rectified.
std::optional<Camera> read_second(OrbSettings& settings, OrbCamera type, double metres,
                                  Camera& first, KnownButUnused& unused) {
  const ConfigNode& file = settings.file;
  const bool has_pose = file.get("Stereo.T_c1_c2").defined() || file.get("Tlr").defined();
  if (file.get("Camera2.fx").defined() && (has_pose || type != OrbCamera::rectified)) {
    Camera second = read_orb_camera(settings, "Camera2", type);
    second.camera_from_world = read_first_from_second(settings, metres).inverse();
    unused = {"Camera2 has its own pose", {"Camera.bf", "Stereo.b"}};
    return second;
  }
  const bool has_depth =
      file.get("RGBD.DepthMapFactor").defined() || file.get("DepthMapFactor").defined();
  if (has_depth) {
    unused = {"no baseline: the file is of one camera with depth", {"Camera.bf", "Stereo.b"}};
    return std::nullopt;
  }
  const bool older = file.get("Camera.fx").defined();
  const double bf =
      older && settings.optional("Camera.bf").defined() ? settings.number("Camera.bf") : 0;
  if (file.get("LEFT.K").defined() && file.get("RIGHT.K").defined()) {
    const RawCamera left = read_raw(settings, "LEFT", metres);
    const RawCamera right = read_raw(settings, "RIGHT", metres);
    if (agree(left, right, first, bf)) {
      first = left.camera;
      Camera second = right.camera;
      second.camera_from_world = second_from_first(left.rectified, right.rectified);
      return second;
    }
    std::erase_if(settings.used, [](const std::string& key) {
      return key.starts_with("LEFT.") || key.starts_with("RIGHT.");
    });
    unused = {"LEFT and RIGHT do not lead to Camera.fx, cx, cy and bf", {"LEFT.*", "RIGHT.*"}};
  }
  double baseline = 0;
  if (bf != 0) baseline = bf / first.fx;
  if (!older && type == OrbCamera::rectified) baseline = settings.number("Stereo.b");
  if (baseline == 0) return std::nullopt;
  Camera second =
      file.get("Camera2.fx").defined() ? read_orb_camera(settings, "Camera2", type) : first;
  second.camera_from_world.translation() = Eigen::Vector3d(-metres * baseline, 0, 0);
  return second;
}

}  // namespace

bool is_orb_slam(const ConfigNode& file) {
  return file.get("Camera.fx").defined() || file.get("Camera1.fx").defined();
}

std::vector<NamedCamera> read_orb_slam(const ConfigNode& file, const CalibrationSettings& settings,
                                       std::vector<std::string>& notes) {
  OrbSettings orb{file, {}};
  const bool older = file.get("Camera.fx").defined();
  const OrbCamera type = type_of(orb);
  Camera first = read_orb_camera(orb, older ? "Camera" : "Camera1", type);
  KnownButUnused unused;
  const std::optional<Camera> second =
      read_second(orb, type, metres_per_unit(file, settings), first, unused);
  std::vector<NamedCamera> out{{"left", first}};
  if (second) out.push_back({"right", *second});
  const bool raw = std::ranges::find(orb.used, "LEFT.K") != orb.used.end();
  if (raw) {
    notes.push_back(
        fmt::format("{}: LEFT and RIGHT are read, the cameras of pictures before "
                    "rectification; for rectified pictures remove them",
                    settings.file.string()));
  }
  note_unused_settings(orb, settings.file.string(), unused, notes);
  return out;
}

}  // namespace hypotrack::calibration::internal
