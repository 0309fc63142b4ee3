#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdlib.h>

#include <array>
#include <filesystem>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "doctor/probe.hpp"

namespace hypotrack::doctor {
namespace {

/// Writes a video of some frames and reads it. Returns whether its first frame is there.
bool writes(const std::string& file, const char* codec) {
  constexpr int kFrames = 4;
  const cv::Mat frame(64, 96, CV_8UC3, cv::Scalar(40, 120, 200));
  {
    cv::VideoWriter writer(file, cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]),
                           30, frame.size());
    if (!writer.isOpened()) return false;
    for (int i = 0; i < kFrames; ++i) writer.write(frame);
  }
  cv::VideoCapture capture(file);
  cv::Mat read;
  return capture.read(read) && read.size() == frame.size();
}

}  // namespace

Check probe_video() {
  std::string folder = (std::filesystem::temp_directory_path() / "hypotrack_XXXXXX").string();
  if (!mkdtemp(folder.data()))
    return {.state = State::broken,
            .found = "no folder can be made in " + std::filesystem::temp_directory_path().string(),
            .fix = "make it writable, or set TMPDIR"};
  std::vector<std::string> good;
  for (const char* codec : {"avc1", "mp4v"})  // in the order of the output `overlay`
    if (writes(folder + "/" + codec + ".mp4", codec)) good.emplace_back(codec);
  std::filesystem::remove_all(folder);
  if (good.empty())
    return {.state = State::broken,
            .found = "OpenCV writes neither avc1 nor mp4v into .mp4",
            .fix =
                "take an OpenCV with FFmpeg (sudo apt-get install libopencv-dev), or run with "
                "--set output.overlay=false"};
  const bool in_browsers = good.front() == "avc1";
  return {.found = fmt::format("OpenCV writes {} into .mp4{}", fmt::join(good, " and "),
                               in_browsers ? "" : ", which browsers do not play")};
}

}  // namespace hypotrack::doctor
