#include <algorithm>
#include <string>
#include <utility>

#include "camera/calibration_text.hpp"
#include "camera/camera_fields.hpp"
#include "camera/formats/depthai_board.hpp"
#include "camera/formats/formats.hpp"
#include "camera/formats/unused_keys.hpp"

namespace hypotrack::calibration::internal {
namespace {

constexpr int kRgb = 0, kLeft = 1, kRight = 2;
constexpr int kNewestVersion = 7;

/// A socket and what its camera is called.
using NamedSocket = std::pair<int, std::string>;

/// The sockets of the left and the right camera.
using Pair = std::pair<int, int>;

/// Returns the pair that a file names, or else the usual one.
Pair pair_of(const ConfigNode& file) {
  const auto socket = [&](const char* key, int usual) {
    const ConfigNode node = file.get("stereoRectificationData").get(key);
    const int said = node.defined() ? read_socket(node.scalar(), node.where()) : kNoSocket;
    return said == kNoSocket ? usual : said;
  };
  return {socket("leftCameraSocket", kLeft), socket("rightCameraSocket", kRight)};
}

/// Returns the names by which `cameras` may choose a camera. The first is its own.
std::vector<std::string> names_of(int socket, const Pair& pair) {
  std::vector<std::string> out{fmt::format("CAM_{}", static_cast<char>('A' + socket)),
                               std::to_string(socket)};
  if (socket == kRgb) out.emplace_back("rgb");
  if (socket == pair.second) out.insert(out.begin(), "right");
  if (socket == pair.first) out.insert(out.begin(), "left");
  return out;
}

bool is_fisheye_lens(const ConfigNode& node) {
  constexpr std::array<std::string_view, 4> kTypes = {"0", "1", "Perspective", "Fisheye"};
  const ConfigNode type = node.get("cameraType");
  return type.defined() && index_of(type, "cameraType", kTypes) % 2 == 1;
}

/// Reads the first 4 of 14 numbers.
void read_fisheye_lens(const ConfigNode& lens, Camera& camera) {
  constexpr std::size_t kCount = 4;
  std::vector<double> k = read_matrix(lens, "distortionCoeff").values;
  const bool padded =
      std::all_of(k.begin() + static_cast<std::ptrdiff_t>(std::min(kCount, k.size())), k.end(),
                  [](double v) { return v == 0; });
  if (k.size() < kCount || !padded) {
    throw DataError(
        fmt::format("{}: distortionCoeff of a fisheye lens has {} numbers; expected 4, "
                    "or zeros after them",
                    lens.where(), k.size()));
  }
  k.resize(kCount);
  camera.distortion = std::move(k);
  camera.distortion_model = DistortionModel::fisheye;
}

Camera read_board_camera(const ConfigNode& node, const CalibrationSettings& settings,
                         std::vector<std::string>& notes) {
  constexpr std::string_view kAdvice = "expected a calibration of depthai";
  Camera camera;
  camera.width = read_count(required(node, {"width"}, kAdvice), "width");
  camera.height = read_count(required(node, {"height"}, kAdvice), "height");
  read_intrinsics(node.get("intrinsicMatrix"), camera);
  const ConfigNode lens = node.get("distortionCoeff");
  if (is_fisheye_lens(node)) {
    read_fisheye_lens(required(node, {"distortionCoeff"}, kAdvice), camera);
    return camera;
  }
  const bool absent = !lens.is_list() || lens.size() == 0;
  if (absent && settings.model != DistortionModel::none) {
    throw DataError(
        fmt::format("{}: has no distortionCoeff; expected the lens. Calibrate again, or "
                    "write `model: none` for pictures without distortion",
                    node.where()));
  }
  if (absent) return camera;
  read_lens(lens, settings.model, camera);
  if (std::ranges::all_of(camera.distortion, [](double k) { return k == 0; }))
    notes.push_back(fmt::format("{}: distortionCoeff has zeros only: no distortion", lens.where()));
  return camera;
}

/// Returns the cameras that the settings name, all if one of them is not on the board. Settings
/// without names mean the stereo pair if there is one, or else all cameras.
std::vector<NamedSocket> chosen_sockets(const Board& board, const Pair& pair,
                                        const CalibrationSettings& settings) {
  if (settings.cameras.empty() && pair.first != pair.second && board.contains(pair.first) &&
      board.contains(pair.second))
    return {{pair.first, "left"}, {pair.second, "right"}};
  std::vector<NamedSocket> out, all;
  for (const auto& [socket, camera] : board) all.emplace_back(socket, names_of(socket, pair)[0]);
  for (const std::string& wanted : settings.cameras) {
    const auto found = std::ranges::find_if(board, [&](const auto& item) {
      const std::vector<std::string> names = names_of(item.first, pair);
      return std::ranges::find(names, wanted) != names.end();
    });
    if (found == board.end()) return all;
    out.emplace_back(found->first, wanted);
  }
  return out.empty() ? all : out;
}

/// Adds one note on what of a file is not used.
void note_unused_of_board(const ConfigNode& file, const std::string& file_name, const Board& board,
                          const std::vector<NamedSocket>& sockets, KeyPaths empty,
                          std::vector<std::string>& notes) {
  KeyPaths used{"version",
                "batchName",
                "batchTime",
                "boardConf",
                "boardCustom",
                "boardName",
                "boardOptions",
                "boardRev",
                "deviceName",
                "hardwareConf",
                "productName",
                "units",
                "cameraData/*/0",
                "stereoRectificationData/leftCameraSocket",
                "stereoRectificationData/rightCameraSocket"};
  KeyPaths others;
  for (const auto& [socket, camera] : board) {
    if (std::ranges::find(sockets, socket, &NamedSocket::first) == sockets.end()) {
      others.push_back(camera.path + "/**");
      continue;
    }
    append_below(
        {camera.path},
        {"width", "height", "cameraType", "intrinsicMatrix", "distortionCoeff", "lensPosition",
         "specHfovDeg", "extrinsics/toCameraSocket", "extrinsics/rotationMatrix"},
        used);
    append_below(
        {camera.path + "/extrinsics/translation", camera.path + "/extrinsics/specTranslation"},
        {"x", "y", "z"}, used);
  }
  const std::vector<KnownButUnused> unused{
      {"of other cameras, which `cameras` chooses", others},
      {"without intrinsics", std::move(empty)},
      {"rectification, which follows from the poses",
       {"stereoRectificationData/rectifiedRotationLeft",
        "stereoRectificationData/rectifiedRotationRight"}},
      {"of the IMU, the housing and the depth that the device computes",
       {"imuExtrinsics/**", "housingExtrinsics/**", "miscellaneousData", "stereoUseSpecTranslation",
        "stereoEnableDistortionCorrection", "verticalCameraSocket"}}};
  note_unused_keys(file, file_name, used, unused, notes);
}

void check_version(const ConfigNode& file, std::vector<std::string>& notes) {
  const ConfigNode version = file.get("version");
  if (!version.defined() || read_number(version, "version") <= kNewestVersion) return;
  notes.push_back(fmt::format("{}: version {} is newer than those known here, up to {}",
                              version.where(), version.scalar(), kNewestVersion));
}

}  // namespace

bool is_depthai(const ConfigNode& file) {
  return file.get("cameraData").is_list() || file.get("cameraData").is_map();
}

std::vector<NamedCamera> read_depthai(const ConfigNode& file, const CalibrationSettings& settings,
                                      std::vector<std::string>& notes) {
  const ConfigNode data = file.get("cameraData");
  check_version(file, notes);
  KeyPaths empty;
  const Board board = read_board(data, metres_per_unit(file, settings, LengthUnit::cm), empty);
  if (board.empty()) {
    throw DataError(
        fmt::format("{}: no camera has an intrinsicMatrix: the board is not calibrated; "
                    "calibrate it with depthai or `hypotrack calibrate`",
                    data.where()));
  }
  const std::vector<NamedSocket> sockets = chosen_sockets(board, pair_of(file), settings);
  std::vector<NamedCamera> out;
  for (const auto& [socket, name] : sockets) {
    const ConfigNode& node = board.at(socket).node;
    const auto pose = pose_between(board, sockets.front().first, socket);
    if (!pose) {
      throw DataError(
          fmt::format("{}: no chain of extrinsics leads from {} to {}; expected rotationMatrix, "
                      "translation and "
                      "toCameraSocket. `cameras` chooses others, or one alone",
                      node.where(), sockets.front().second, name));
    }
    const BoardCamera& place = board.at(socket);
    const bool used = std::ranges::find(sockets, place.to, &NamedSocket::first) != sockets.end();
    if (used) notes.insert(notes.end(), place.notes.begin(), place.notes.end());
    out.push_back({name, read_board_camera(node, settings, notes)});
    out.back().camera.camera_from_world = *pose;
  }
  note_unused_of_board(file, settings.file.string(), board, sockets, std::move(empty), notes);
  return out;
}

}  // namespace hypotrack::calibration::internal
