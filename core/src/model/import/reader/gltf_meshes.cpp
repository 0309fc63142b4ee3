#include "model/import/reader/gltf_meshes.hpp"

#include <algorithm>
#include <stdexcept>

namespace hypotrack::mesh_wire::internal {
namespace {

constexpr const char* kDraco = "KHR_draco_mesh_compression";

void check_count(std::size_t count, std::size_t vertices, const std::string& what) {
  if (count != vertices)
    throw std::runtime_error(what + " has " + std::to_string(count) + " values for " +
                             std::to_string(vertices) + " vertices");
}

/// glTF 2.0, "mesh.primitive.mode".
constexpr std::uint64_t kTriangles = 4, kFan = 6;
std::uint64_t triangles_of(std::uint64_t mode, std::uint64_t corners) {
  if (mode > kFan)
    throw std::runtime_error("a primitive has the unknown mode " + std::to_string(mode));
  if (mode == kTriangles) return corners / 3;
  return corners > 2 ? corners - 2 : 0;  // a strip or a fan
}

}  // namespace

/// Copies an accessor as floats. `vertices`: the number of values that it must have; 0: any.
const GltfMeshes::Copied& GltfMeshes::floats(const Json& index,
                                             const std::vector<std::size_t>& widths,
                                             std::size_t vertices, const std::string& what,
                                             double scale) {
  const std::pair key(whole(index, what), scale);
  auto known = copied_.find(key);
  if (known == copied_.end() || std::ranges::find(widths, known->second.width) == widths.end()) {
    GltfValues values = read_accessor(file_, index, widths, what);
    for (double& number : values.numbers) number *= scale;
    const Copied copy{to_.add<float>(values, kFloats), values.width, values.count()};
    known = copied_.insert_or_assign(key, copy).first;
  }
  if (vertices != 0) check_count(known->second.count, vertices, what);
  return known->second;
}

/// Returns an accessor of vertices' numbers.
std::size_t GltfMeshes::numbers(std::size_t vertices) {
  const auto [known, is_new] = numbers_.try_emplace(vertices);
  if (is_new) {
    GltfValues values{3, {}};
    for (std::size_t i = 0; i < vertices; ++i) {
      const VertexNumber number(i);
      values.numbers.insert(values.numbers.end(), {number.low, number.high, 0});
    }
    known->second = to_.add<float>(values, kFloats);
  }
  return known->second;
}

void GltfMeshes::copy_indices(Json& primitive, std::size_t vertices, const std::string& name) {
  const std::uint64_t mode = whole(primitive, "mode", kTriangles);
  const Json& index = member(primitive, "indices");
  if (index.is_null()) {
    triangles_ += triangles_of(mode, vertices);
    return;
  }
  const GltfValues corners = read_accessor(file_, index, {1}, name + " indices");
  const auto missing = [&](double corner) {
    return !(corner >= 0 && corner < static_cast<double>(vertices));
  };
  triangles_ += triangles_of(mode, corners.count());
  if (std::ranges::none_of(corners.numbers, missing)) {
    primitive["indices"] = to_.add<std::uint32_t>(corners, kWords);
    return;
  }
  const std::size_t step = mode == kTriangles ? 3 : 1;
  const std::uint64_t before = lost_triangles_;
  for (std::size_t i = 0; i + 3 <= corners.numbers.size(); i += step) {
    const auto first = corners.numbers.begin() + static_cast<std::ptrdiff_t>(i);
    lost_triangles_ += std::any_of(first, first + 3, missing) ? 1 : 0;
  }
  lost_triangles_ = std::max(lost_triangles_, before + 1);
}

/// Copies the influences of all sets, JOINTS_0 and WEIGHTS_0 to JOINTS_7 and WEIGHTS_7.
void GltfMeshes::copy_influences(const Json& from, std::size_t vertices, const std::string& name,
                                 Json& to) {
  constexpr int kMostSets = 8;
  std::vector<double> sums(vertices), wrong(vertices);
  for (int set = 0; set < kMostSets; ++set) {
    const std::string number = std::to_string(set);
    const std::string joints = "JOINTS_" + number, weights = "WEIGHTS_" + number;
    if (!from.contains(joints) || !from.contains(weights)) break;
    GltfValues indices = read_accessor(file_, from[joints], {4}, name + " " + joints);
    check_count(indices.count(), vertices, name + " " + joints);
    for (double& index : indices.numbers) index = index >= 0 && index <= 65535 ? index : 65535;
    to[joints] = to_.add<std::uint16_t>(indices, kShorts);
    to[weights] = floats(from[weights], {4}, vertices, name + " " + weights).index;
    const GltfValues values = read_accessor(file_, from[weights], {4}, name + " " + weights);
    for (std::size_t i = 0; i < values.numbers.size(); ++i)
      (values.numbers[i] >= 0 ? sums : wrong)[i / 4] += values.numbers[i];
  }
  // Vertices without any weight are refused later, if triangles use them.
  for (std::size_t i = 0; i < vertices; ++i)
    if (wrong[i] != 0 && sums[i] > 0)
      throw std::runtime_error("the weights of vertex " + std::to_string(i) + " of " +
                               name.substr(0, name.size() - 1) +
                               " are not all numbers from 0 to 1; export the file again");
}

/// Adds the displacements of morph targets, times their weights, to positions (glTF 2.0, section
/// 3.7.2.2).
void GltfMeshes::add_targets(const Json& targets, const std::vector<double>& weights,
                             GltfValues& positions, const std::string& name) {
  for (std::size_t t = 0; t < weights.size() && t < targets.size(); ++t) {
    const Json& index = member(targets[t], "POSITION");
    if (weights[t] == 0 || index.is_null()) continue;
    const std::string what = name + " morph target " + std::to_string(t);
    const GltfValues moved = read_accessor(file_, index, {3}, what);
    check_count(moved.count(), positions.count(), what);
    for (std::size_t i = 0; i < moved.numbers.size(); ++i)
      positions.numbers[i] += weights[t] * moved.numbers[i];
  }
}

/// Copies the positions of a primitive as its morph targets move them.
GltfMeshes::Copied GltfMeshes::copy_positions(const Json& primitive, const Json& targets,
                                              const std::vector<double>& weights, double scale,
                                              const std::string& name) {
  const Json& index = member(member(primitive, "attributes"), "POSITION");
  const bool moved = std::ranges::any_of(weights, [](double weight) { return weight != 0; });
  if (!moved || targets.empty()) return floats(index, {3}, 0, name + " POSITION", scale);
  GltfValues positions = read_accessor(file_, index, {3}, name + " POSITION");
  add_targets(targets, weights, positions, name);
  for (double& number : positions.numbers) number *= scale;
  return {to_.add<float>(positions, kFloats), positions.width, positions.count()};
}

void GltfMeshes::copy_primitive(Json& primitive, const std::vector<double>& weights, double scale,
                                const std::string& name) {
  const Json targets = list(primitive, "targets");
  primitive.erase("targets");
  if (!member(member(primitive, "extensions"), kDraco).is_null())
    return keep_draco(primitive, name);
  const Json from = member(primitive, "attributes");
  Json to = Json::object();
  const Copied positions = copy_positions(primitive, targets, weights, scale, name);
  const std::size_t vertices = positions.count;
  to["POSITION"] = positions.index;
  for (const auto& [key, index] : from.items()) {
    const std::string what = name + " " + key;
    if (key.starts_with("TEXCOORD_")) to[key] = floats(index, {2}, vertices, what).index;
    if (key == "COLOR_0") to[key] = floats(index, {3, 4}, vertices, what).index;
  }
  copy_influences(from, vertices, name, to);
  to["NORMAL"] = numbers(vertices);
  primitive["attributes"] = std::move(to);
  copy_indices(primitive, vertices, name);
}

/// Keeps a primitive that assimp unpacks. It takes the bits of its values for floats, too.
void GltfMeshes::keep_draco(Json& primitive, const std::string& name) {
  const auto keep = [&](Json& index, bool floats) {
    Json accessor = item(file_.root(), "accessors", index);
    if (floats && whole(member(accessor, "componentType"), "componentType") != kFloats)
      throw std::runtime_error(name + " it has numbers that are compressed with " + kDraco +
                               " and are no floats; export it again without compression");
    accessor.erase("bufferView");
    accessor.erase("sparse");
    index = to_.add_accessor(std::move(accessor));
  };
  if (primitive.contains("indices")) keep(primitive["indices"], false);
  for (auto& [key, index] : primitive["attributes"].items())
    keep(index, key == "POSITION" || key.starts_with("TEXCOORD_") || key.starts_with("WEIGHTS_"));
  Json& packed = primitive["extensions"][kDraco];
  primitive["attributes"].erase("NORMAL");  // they are no numbers of vertices
  packed["bufferView"] = to_.add_view(file_.view(member(packed, "bufferView")));
}

void GltfMeshes::copy(Json& root, const std::vector<double>& scales) {
  std::size_t number = 0;
  for (Json& mesh : root["meshes"]) {
    const std::string own = text(mesh, "name");
    const std::string name =
        "mesh " + (own.empty() ? std::to_string(number) : "'" + own + "'") + ":";
    const double scale = scales[number++];
    Json kept = Json::array();
    for (const Json& primitive : list(mesh, "primitives")) {
      const bool flat = whole(primitive, "mode", kTriangles) < kTriangles;  // points or lines
      if (flat || member(member(primitive, "attributes"), "POSITION").is_null()) continue;
      kept.push_back(primitive);
      copy_primitive(kept.back(), morph_weights(mesh), scale, name);
    }
    mesh["primitives"] = std::move(kept);
    mesh.erase("weights");
  }
  if (lost_triangles_ > 0)
    throw std::runtime_error(std::to_string(lost_triangles_) + " of its " +
                             std::to_string(triangles_) +
                             " triangles name vertices that are not there");
}

}  // namespace hypotrack::mesh_wire::internal
