#include <fmt/core.h>

#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "gltf.hpp"
#include "hand_asset.hpp"

namespace {

constexpr int kTextureSize = 1024;

/// Writes through a temporary name, so that an interrupted run leaves no half of a file.
void write_file(const std::filesystem::path& file, const std::string& bytes) {
  const std::filesystem::path part = file.string() + ".part";
  {
    std::ofstream stream(part, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) throw std::runtime_error("cannot write " + part.string());
  }
  std::filesystem::rename(part, file);
}

}  // namespace

/// hypotrack_hand_mesh OUT_DIR: makes hypotrack's own right hand, OUT_DIR/hypotrack_hand.glb.
int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: {} OUT_DIR\n", argc > 0 ? argv[0] : "hypotrack_hand_mesh");
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    const auto hand = hypotrack::hand_mesh::make_hand(kTextureSize);
    write_file(folder / "hypotrack_hand.glb", hypotrack::hand_mesh::to_glb(hand));
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "hypotrack_hand_mesh: {}\n", error.what());
    return 1;
  }
}
