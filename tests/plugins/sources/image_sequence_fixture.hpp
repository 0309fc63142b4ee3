#pragma once

#include <string>

#include "hypotrack/api/media.hpp"
#include "source_fixture.hpp"

namespace hypotrack::test {

/// Numbered pairs of pictures.
class ImageSequence : public SourceFixture {
 protected:
  void write_pair(int number, const char* extension = "png") {
    for (int v = 0; v < 2; ++v) {
      write_image(file(cv::format("%s_%04d.%s", v ? "right" : "left", number, extension)).string(),
                  picture(number, v));
    }
  }
  std::string numbered(const std::string& more = "") const {
    return "type: image_sequence\nleft: left_%04d.png\nright: right_%04d.png\n"
           "calibration: {file: rig.yml}\n" +
           more;
  }
  auto making(const std::string& yaml) {
    return [this, yaml] { make(yaml, &scene_); };
  }
};

}  // namespace hypotrack::test
