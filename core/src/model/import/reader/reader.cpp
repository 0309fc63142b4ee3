// hypotrack_mesh_reader FILE SECONDS: reads a mesh file with assimp and writes its content to
// standard output (wire.hpp). It is a separate program because assimp may crash or hang on a
// damaged file, and a forked process of a program with threads may not allocate.

#include <sys/resource.h>
#include <unistd.h>

#include <charconv>
#include <exception>
#include <string_view>

#include "base/standard_streams.hpp"
#include "model/import/reader/read_scene.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

constexpr rlim_t kMemoryLimit = rlim_t{4} << 30;

void limit_resources(rlim_t seconds) {
  const rlimit memory{kMemoryLimit, kMemoryLimit};
  setrlimit(RLIMIT_AS, &memory);
  const rlimit cpu{seconds, seconds};
  setrlimit(RLIMIT_CPU, &cpu);
  const rlimit core{0, 0};
  setrlimit(RLIMIT_CORE, &core);
}

bool write_all(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace
}  // namespace hypotrack::mesh_wire::internal

int main(int argc, char** argv) {
  namespace wire = hypotrack::mesh_wire;
  hypotrack::open_standard_streams();
  unsigned seconds = 0;
  if (argc != 3 ||
      std::from_chars(argv[2], argv[2] + std::string_view(argv[2]).size(), seconds).ec !=
          std::errc()) {
    return 2;
  }
  wire::limit_resources(seconds);
  wire::Scene scene;
  try {
    scene = wire::read_scene(argv[1]);
  } catch (const std::exception& error) {
    scene = {};
    scene.error = error.what();
  }
  return wire::write_all(wire::encode(scene)) ? 0 : 1;
}
