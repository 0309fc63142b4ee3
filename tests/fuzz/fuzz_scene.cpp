// libFuzzer's entry: any bytes are a scene or a ConfigError.
#include <stdlib.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "read_scene.hpp"

namespace {

/// A folder for the scene and for the other one that it may include.
const std::filesystem::path& folder() {
  static const std::filesystem::path path = [] {
    std::string name = (std::filesystem::temp_directory_path() / "fuzz_scene_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("cannot make a temporary folder");
    hypotrack::test::write_other_scene(name);
    return std::filesystem::path(name);
  }();
  return path;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  hypotrack::test::read_scene({reinterpret_cast<const char*>(data), size}, folder());
  return 0;
}
