// libFuzzer's entry: any bytes are a scene or a ConfigError.
#include <cstddef>
#include <cstdint>

#include "read_scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  hypotrack::test::read_scene({reinterpret_cast<const char*>(data), size});
  return 0;
}
