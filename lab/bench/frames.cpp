#include "lab/bench/frames.hpp"

#include <fmt/format.h>

#include "hypotrack/api/error.hpp"
#include "session/opened_scene.hpp"

namespace hypotrack::bench::internal {
namespace {

/// Returns a key of everything that decides the frames.
std::string source_of(const Case& c) {
  const LoadedScene scene = load_scene(c.file, c.overrides);
  return fmt::format("{}\n{}\n{}\n{}", c.directory.string(), c.file.parent_path().string(),
                     scene.file.models.to_yaml(), scene.file.source.to_yaml());
}

std::vector<Frame> read(Source& source, int usable, const Case& c) {
  std::vector<Frame> frames;
  for (int found = 0; found < usable;) {
    auto frame = source.next();
    if (!frame) break;
    const bool is_usable = !frame->views.empty();
    found += is_usable;
    if (is_usable || found > 0) frames.push_back(*std::move(frame));
  }
  if (frames.empty())
    throw DataError(fmt::format("{}: the source has no frame that can be used", c.file.string()));
  return frames;
}

}  // namespace

std::vector<Frame>& Frames::of(const Case& c) {
  enter_directory(c);
  const std::string source = source_of(c);
  if (source == source_) return frames_;
  source_.clear();
  frames_.clear();  // free them first: one source's frames may fill the memory
  frames_ = read(*open_source(c.file, c.overrides, *plugins_).source, usable_, c);
  source_ = source;
  return frames_;
}

void renew_images(std::vector<Frame>& frames) {
  const auto renew = [](cv::Mat& image) {
    const bool made_elsewhere = image.u && image.u->currAllocator != cv::Mat::getDefaultAllocator();
    if (made_elsewhere) image = image.clone();
  };
  for (Frame& frame : frames) {
    for (View& view : frame.views) {
      renew(view.color);
      renew(view.mask);
      renew(view.depth);
    }
  }
}

}  // namespace hypotrack::bench::internal
