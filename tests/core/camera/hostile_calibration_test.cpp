// Calibrations whose numbers are replaced one by one.

#include <gmock/gmock.h>

#include <cctype>

#include "calibration_files.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

using testing::HasSubstr;

/// Returns where the numbers of a text begin and end.
std::vector<std::pair<std::size_t, std::size_t>> numbers_of(const std::string& text) {
  const auto is_part = [&](std::size_t i) {
    return std::isdigit(static_cast<unsigned char>(text[i])) || text[i] == '.' || text[i] == '-';
  };
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (!is_part(i) || (text[i - 1] != ' ' && text[i - 1] != '[' && text[i - 1] != '=')) continue;
    std::size_t end = i;
    while (end < text.size() && (is_part(end) || text[end] == 'e')) ++end;
    out.emplace_back(i, end);
    i = end;
  }
  return out;
}

class HostileCalibrations : public test::CalibrationFiles {};

TEST_F(HostileCalibrations, EndWithAnErrorThatNamesTheFileOrInValidCameras) {
  int refused = 0, read = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::source_dir() / "tests/fuzz/corpus/calibration")) {
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto numbers = numbers_of(text);
    ASSERT_GE(numbers.size(), 6u) << entry.path();
    std::size_t turn = 0;
    for (const auto& [begin, end] : numbers) {
      constexpr const char* kValues[] = {"nan",    "1e300", "-1e300", "[]",
                                         "1e-300", "{}",    "word",   "0"};
      std::string hostile = text;
      hostile.replace(begin, end - begin, kValues[turn++ % std::size(kValues)]);
      CalibrationSettings settings = file("hostile", hostile);
      settings.any_baseline = true;
      try {
        for (Camera camera : load_calibration(settings, {1280, 720})) {
          if (camera.width == 0) camera.width = camera.height = 640;
          EXPECT_NO_THROW(validate(camera, "camera")) << hostile;
        }
        ++read;
      } catch (const DataError& e) {
        ++refused;
        EXPECT_THAT(e.what(), HasSubstr("hostile")) << hostile;
      }
    }
  }
  EXPECT_GT(refused, 150);
  EXPECT_GT(read, 20);
}

}  // namespace
}  // namespace hypotrack
