#include "camera/calibration_text.hpp"
#include "camera/camera_fields.hpp"
#include "camera/formats/formats.hpp"
#include "camera/formats/unused_keys.hpp"

namespace hypotrack::calibration::internal {
namespace {

constexpr std::array<std::string_view, 3> kLensModels = {"none", "brown", "fisheye"};

Camera read_listed(const ConfigNode& node, const CalibrationSettings& settings, double metres) {
  constexpr std::array<std::string_view, 9> kKeys = {
      "name", "image_width", "image_height", "model", "K", "D", "R", "T", "imageSize"};
  for (const std::string& key : node.keys()) {
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) {
      throw DataError(fmt::format("{}: a camera has no '{}'; expected {}", node.get(key).where(),
                                  key, fmt::join(kKeys, ", ")));
    }
  }
  Camera camera;
  const ImageSize size = read_size(node);
  camera.width = size.width;
  camera.height = size.height;
  std::optional<DistortionModel> model = settings.model;
  if (const ConfigNode said = node.get("model"); said.defined()) {
    model = static_cast<DistortionModel>(index_of(said, "model", kLensModels));
  }
  read_intrinsics(required(node, {"K"}, "expected K, a 3x3 matrix, for every camera"), camera);
  read_lens(node.get("D"), model, camera);
  if (model.value_or(DistortionModel::none) != DistortionModel::none && !node.get("D").defined()) {
    throw DataError(
        fmt::format("{}: has a lens model but no D; expected its coefficients", node.where()));
  }
  const ConfigNode r = node.get("R");
  const ConfigNode t = node.get("T");
  if (r.defined() != t.defined()) {
    throw DataError(
        fmt::format("{}: gives only one of R and T; expected both or none", node.where()));
  }
  if (r.defined()) read_pose(r, t, metres, camera);
  return camera;
}

}  // namespace

std::vector<NamedCamera> read_camera_list(const ConfigNode& file,
                                          const CalibrationSettings& settings,
                                          std::vector<std::string>& notes) {
  const ConfigNode list = file.get("cameras");
  if (!list.is_list() || list.size() == 0) {
    throw DataError(fmt::format("{}: cameras is no list of cameras", list.where()));
  }
  const double metres = metres_per_unit(file, settings);
  std::vector<NamedCamera> cameras;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const ConfigNode name = list.at(i).get("name");
    cameras.push_back({name.is_scalar() ? name.scalar() : std::to_string(i),
                       read_listed(list.at(i), settings, metres)});
  }
  KeyPaths used = size_keys("");
  append_below({"cameras/*"}, {"name", "model", "K", "D", "R", "T"}, used);
  append(size_keys("cameras/*/"), used);
  used.push_back("units");
  note_unused_keys(file, settings.file.string(), used, {}, notes);
  return cameras;
}

}  // namespace hypotrack::calibration::internal
