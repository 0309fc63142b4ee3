#include "camera/formats/depthai_board.hpp"

#include <charconv>
#include <utility>

#include "camera/calibration_text.hpp"
#include "camera/camera_fields.hpp"

namespace hypotrack::calibration::internal {
namespace {

constexpr int kNoSocketAsByte = 255;  // of older files
constexpr int kLastSocket = 9;        // CAM_J

Eigen::Vector3d read_xyz(const ConfigNode& node, std::string_view name) {
  Eigen::Vector3d out;
  for (const auto& [key, i] : {std::pair{"x", 0}, {"y", 1}, {"z", 2}}) {
    const std::string advice = fmt::format("expected x, y and z of {}", name);
    out[i] = read_number(required(node, {key}, advice), name);
  }
  return out;
}

/// Adds a note if calibration and drawing differ by more than 3 %.
void compare(const Eigen::Vector3d& t, const Eigen::Vector3d& drawn, const std::string& where,
             std::vector<std::string>& notes) {
  constexpr double kFar = 0.03;
  if (drawn.isZero() || std::abs(t.norm() - drawn.norm()) <= kFar * drawn.norm()) return;
  notes.push_back(fmt::format(
      "{}: the cameras are {:.4g} cm apart by calibration, which is taken, and {:.4g} cm by the "
      "drawing (specTranslation); was the size of the board's squares right?",
      where, t.norm(), drawn.norm()));
}

/// Returns where a camera stands to the one that its extrinsics name. The translation of the
/// calibration counts; that of the drawing replaces it where it is 0.
std::optional<Eigen::Isometry3d> read_extrinsics(const ConfigNode& node, double metres,
                                                 std::vector<std::string>& notes) {
  const ConfigNode rotation = node.get("rotationMatrix");
  if (is_unknown_matrix(rotation, "rotationMatrix")) return std::nullopt;
  const YamlMatrix matrix = read_matrix(rotation, "rotationMatrix");
  expect_shape(matrix, 3, 3);
  constexpr std::string_view kAdvice = "expected x, y and z in centimetres";
  Eigen::Vector3d t = read_xyz(required(node, {"translation"}, kAdvice), "translation");
  const ConfigNode spec = node.get("specTranslation");
  const Eigen::Vector3d drawn =
      spec.defined() ? read_xyz(spec, "specTranslation") : Eigen::Vector3d::Zero();
  if (t.isZero() && drawn.isZero()) return std::nullopt;
  if (t.isZero()) {
    notes.push_back(
        fmt::format("{}: translation is 0; specTranslation, that of the drawing, is taken for it",
                    node.where()));
    t = drawn;
  }
  compare(t, drawn, node.where(), notes);
  Camera holder;
  set_pose(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix.values.data()),
           metres * t, matrix.where, holder);
  return holder.camera_from_world;
}

BoardCamera read_place(const ConfigNode& node, std::string path, double metres) {
  BoardCamera out{node, std::move(path), kNoSocket, std::nullopt, {}};
  const ConfigNode extrinsics = node.get("extrinsics");
  const ConfigNode to = extrinsics.get("toCameraSocket");
  if (to.defined()) out.to = read_socket(to.scalar(), to.where());
  if (out.to != kNoSocket) out.to_from_camera = read_extrinsics(extrinsics, metres, out.notes);
  return out;
}

}  // namespace

int read_socket(const std::string& text, const std::string& where) {
  for (const auto& [name, socket] : {std::pair{"AUTO", kNoSocket},
                                     {"RGB", 0},
                                     {"CENTER", 0},
                                     {"LEFT", 1},
                                     {"RIGHT", 2},
                                     {"VERTICAL", 3}})
    if (text == name) return socket;
  if (text.size() == 5 && text.starts_with("CAM_") && text[4] >= 'A' &&
      text[4] <= 'A' + kLastSocket)
    return text[4] - 'A';
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  if (whole && number == kNoSocketAsByte) return kNoSocket;
  if (whole && number >= kNoSocket && number <= kLastSocket) return number;
  throw DataError(
      fmt::format("{}: the camera's socket is '{}'; expected -1 to {}, or CAM_A to CAM_J", where,
                  text.substr(0, 40), kLastSocket));
}

Board read_board(const ConfigNode& data, double metres, std::vector<std::string>& empty) {
  Board board;
  const auto add = [&](int socket, const ConfigNode& node, const std::string& path) {
    if (socket == kNoSocket || !node.is_map() || board.contains(socket)) {
      throw DataError(fmt::format("{}: expected a camera, one for a socket from 0 to {}",
                                  node.where(), kLastSocket));
    }
    if (is_unknown_matrix(node.get("intrinsicMatrix"), "intrinsicMatrix"))
      empty.push_back(path + "/**");
    else
      board.emplace(socket, read_place(node, path, metres));
  };
  if (data.is_map()) {
    for (const std::string& key : data.keys())
      add(read_socket(key, data.where_key(key)), data.get(key), "cameraData/" + key);
  }
  for (std::size_t i = 0; data.is_list() && i < data.size(); ++i) {
    const ConfigNode pair = data.at(i);
    if (!pair.is_list() || pair.size() != 2)
      throw DataError(fmt::format("{}: expected a pair of a socket and a camera", pair.where()));
    add(read_socket(pair.at(0).scalar(), pair.where()), pair.at(1),
        fmt::format("cameraData/{}/1", i));
  }
  return board;
}

std::optional<Eigen::Isometry3d> pose_between(const Board& board, int from, int to) {
  std::map<int, Eigen::Isometry3d> reached{{from, Eigen::Isometry3d::Identity()}};
  for (bool more = true; more && !reached.contains(to);) {
    more = false;
    for (const auto& [socket, camera] : board) {
      const bool here = reached.contains(socket), there = reached.contains(camera.to);
      if (!camera.to_from_camera || here == there) continue;
      if (here)
        reached.emplace(camera.to, *camera.to_from_camera * reached.at(socket));
      else
        reached.emplace(socket, camera.to_from_camera->inverse() * reached.at(camera.to));
      more = true;
    }
  }
  if (!reached.contains(to)) return std::nullopt;
  return reached.at(to);
}

}  // namespace hypotrack::calibration::internal
