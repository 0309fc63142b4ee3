#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/frame.h>
}

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace hypotrack::test {

/// What write_video() writes.
struct VideoRecipe {
  std::string codec = "mpeg4";
  AVPixelFormat pixels = AV_PIX_FMT_YUV420P;
  int width = 64, height = 48;
  AVRational tick{1, 600};            ///< unit of `times`
  std::vector<std::int64_t> times{};  ///< when each frame is shown; those before 0 are edited out
  /// Fills frame i; default: its first plane has the value 20 + 10 i, others 128.
  std::function<void(AVFrame&, int)> paint{};
  int reordered = 0;  ///< B frames in a row
  AVColorSpace matrix = AVCOL_SPC_UNSPECIFIED;
  AVColorRange range = AVCOL_RANGE_UNSPECIFIED;
  AVRational aspect{0, 1};
  std::optional<std::array<std::int32_t, 9>> display{};  ///< display matrix
  std::optional<std::size_t> damaged{};                  ///< frame whose packet is overwritten
  std::array<const char*, 2> metadata{};                 ///< a key of the stream and its value
};

/// Fills a plane of 8-bit samples.
void fill_plane(AVFrame& frame, int plane, int value);

/// Writes a video; the file's ending chooses its container. Throws std::runtime_error.
void write_video(const std::filesystem::path& file, const VideoRecipe& recipe);

}  // namespace hypotrack::test
