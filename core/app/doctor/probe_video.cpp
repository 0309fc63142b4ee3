#include <fmt/format.h>
#include <stdlib.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>

#include "doctor/probe.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"

namespace hypotrack::doctor {
namespace {

/// Writes a video of some frames as the output `overlay` does, and reads it. Returns the codec.
std::string written_codec(const std::string& file) {
  constexpr int kFrames = 4;
  const cv::Mat frame(64, 96, CV_8UC3, cv::Scalar(40, 120, 200));
  const auto writer = create_video(file, frame.size(), 30);
  for (int i = 0; i < kFrames; ++i) writer->write(frame);
  if (const std::string why = writer->finish(); !why.empty()) throw OutputError(why);
  cv::Mat read;
  const std::string why = open_video(file)->read(0, read);
  if (!why.empty()) throw DataError(why);
  return writer->codec();
}

}  // namespace

Check probe_video() {
  std::string folder = (std::filesystem::temp_directory_path() / "hypotrack_XXXXXX").string();
  if (!mkdtemp(folder.data()))
    return {.state = State::broken,
            .found = "no folder can be made in " + std::filesystem::temp_directory_path().string(),
            .fix = "make it writable, or set TMPDIR"};
  Check out;
  try {
    const std::string codec = written_codec(folder + "/video.mp4");
    out.found = fmt::format("FFmpeg writes {} into .mp4{}", codec,
                            codec == "h264" ? "" : ", which browsers do not play");
  } catch (const Error& error) {
    out = {.state = State::broken,
           .found = error.what(),
           .fix =
               "take an FFmpeg whose libavcodec has libx264, or run with "
               "--set output.overlay=false"};
  }
  std::filesystem::remove_all(folder);
  return out;
}

}  // namespace hypotrack::doctor
