#include "target.hpp"

#include <stdlib.h>

#include <fstream>
#include <stdexcept>

namespace hypotrack::fuzz {
namespace {

/// Returns where temporary files go: into memory, unless TMPDIR says otherwise.
std::filesystem::path temporary() {
  const std::filesystem::path memory = "/dev/shm";
  return !getenv("TMPDIR") && std::filesystem::is_directory(memory)
             ? memory
             : std::filesystem::temp_directory_path();
}

class Scratch {
 public:
  Scratch() {
    std::string name = (temporary() / "hypotrack_fuzz_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("cannot make a temporary folder");
    path = name;
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    std::error_code gone;
    std::filesystem::remove_all(path, gone);
  }
  std::filesystem::path path;
};

}  // namespace

std::vector<Target>& targets() {
  static std::vector<Target> all;
  return all;
}

bool add_target(const Target& target) {
  targets().push_back(target);
  return true;
}

void require(bool holds, std::string_view property) {
  if (!holds) throw std::logic_error("does not hold: " + std::string(property));
}

const std::filesystem::path& scratch() {
  static const Scratch folder;
  return folder.path;
}

std::filesystem::path scratch_file(const std::filesystem::path& name, std::string_view bytes) {
  const std::filesystem::path file = scratch() / name;
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

std::filesystem::path fuzz_folder() {
  return std::filesystem::path(HYPOTRACK_SOURCE_DIR) / "tests" / "fuzz";
}

}  // namespace hypotrack::fuzz
