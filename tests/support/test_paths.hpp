#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace hypotrack::test {

inline std::filesystem::path source_dir() { return HYPOTRACK_SOURCE_DIR; }
inline std::filesystem::path build_dir() { return HYPOTRACK_BUILD_DIR; }
/// The build's plugins; "lib" is another folder in builds for packages.
inline std::filesystem::path plugin_dir() { return build_dir() / HYPOTRACK_PLUGIN_DIR; }

/// Returns the folder of real recordings and meshes that some tests use. It lies beside a checkout
/// and is not part of the project.
inline std::filesystem::path shared_data() {
  return source_dir().parent_path() / "shared" / "data";
}

/// A folder that is removed with the object.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "hypotrack_test_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("cannot make a temporary folder");
    path_ = name;
  }
  ~TemporaryDirectory() { std::filesystem::remove_all(path_); }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace hypotrack::test

/// Skips the test with a message if the shared data does not lie beside the checkout.
#define HYPOTRACK_NEEDS_SHARED_DATA()                                                      \
  if (!std::filesystem::exists(::hypotrack::test::shared_data()))                          \
  GTEST_SKIP() << "needs the shared data in " << ::hypotrack::test::shared_data().string() \
               << ", which is not part of the project"
