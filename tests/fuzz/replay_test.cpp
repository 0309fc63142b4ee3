// Every target reads or refuses its corpus, what was found before, and damaged copies of both.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "damage.hpp"
#include "dictionary.hpp"
#include "target.hpp"

namespace hypotrack::fuzz {

/// Names the parameter of a test.
void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }

namespace {

/// Returns the files of a folder by name, so that their order is that of every machine.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

class Fuzz : public testing::TestWithParam<Target> {
 protected:
  std::vector<std::filesystem::path> files(const char* folder) const {
    return files_in(fuzz_folder() / folder / GetParam().name);
  }
  /// Returns whether the input was read to the end.
  bool read(const std::string& bytes) const {
    return attempt([&] { GetParam().read(bytes); });
  }
};

TEST_P(Fuzz, ReadsOrRefuses) {
  std::vector<std::string> inputs;
  for (const auto& file : files("corpus")) {
    inputs.push_back(bytes_of(file));
    EXPECT_TRUE(read(inputs.back())) << file << " is valid, but was refused";
  }
  ASSERT_FALSE(inputs.empty()) << "there is no corpus/" << GetParam().name;
  for (const auto& file : files("found")) {
    inputs.push_back(bytes_of(file));
    EXPECT_NO_THROW(read(inputs.back())) << file;
  }
  Damage damage(2017, inputs, read_dictionary(GetParam().dictionary));
  for (int i = 0; i < 300; ++i) {
    const std::string input = damage.damaged();
    ASSERT_NO_THROW(read(input)) << "damaged input " << i << ":\n" << input;
  }
}

std::string name_of(const testing::TestParamInfo<Target>& info) {
  return std::string(info.param.name);
}

INSTANTIATE_TEST_SUITE_P(, Fuzz, testing::ValuesIn(targets()), name_of);

}  // namespace
}  // namespace hypotrack::fuzz
