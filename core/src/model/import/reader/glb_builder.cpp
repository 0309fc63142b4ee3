#include "model/import/reader/glb_builder.hpp"

#include <array>
#include <cstdint>
#include <stdexcept>
#include <utility>

namespace hypotrack::mesh_wire::internal {

const char* GlbBuilder::type_of(std::size_t width) {
  constexpr std::array<const char*, 5> kTypes = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  return width < kTypes.size() ? kTypes[width] : "MAT4";
}

std::size_t GlbBuilder::add_accessor(Json about) {
  accessors_.push_back(std::move(about));
  return accessors_.size() - 1;
}

std::size_t GlbBuilder::add_view(std::string_view bytes) {
  constexpr std::size_t kMost = std::size_t{1} << 30;
  binary_.resize((binary_.size() + 3) / 4 * 4);
  if (binary_.size() + bytes.size() > kMost)
    throw std::runtime_error("its meshes take more than 1 GiB: decimate them");
  views_.push_back({{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}});
  binary_ += bytes;
  return views_.size() - 1;
}

std::string GlbBuilder::finish(Json root) && {
  binary_.resize((binary_.size() + 3) / 4 * 4);
  root["accessors"] = std::move(accessors_);
  root["bufferViews"] = std::move(views_);
  root["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
  std::string json = root.dump(-1, ' ', false, Json::error_handler_t::replace);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string glb = "glTF";
  const auto append = [&](std::size_t number) {
    const auto word = static_cast<std::uint32_t>(number);
    glb.append(reinterpret_cast<const char*>(&word), sizeof(word));
  };
  append(2);
  append(12 + 8 + json.size() + 8 + binary_.size());
  append(json.size());
  glb += "JSON" + json;
  append(binary_.size());
  glb.reserve(glb.size() + 4 + binary_.size());
  glb.append("BIN\0", 4);
  return glb += binary_;
}

}  // namespace hypotrack::mesh_wire::internal
