#include "timed_images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/timeline.hpp"
#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack {
namespace {

namespace fs = std::filesystem;

/// A picture whose name has its time, as text and as a number.
struct NamedPicture {
  Stamp stamp;
  std::string text;
  fs::path file;
};

/// A pattern with one * in its file name, where the time stands.
struct NamePattern {
  fs::path folder;
  std::string before, after;

  explicit NamePattern(const fs::path& pattern) : folder(pattern.parent_path()) {
    const std::string name = pattern.filename().string();
    const std::size_t star = name.find('*');
    if (star == std::string::npos || name.find_first_of("*?%", star + 1) != std::string::npos ||
        name.find_first_of("?%") < star) {
      throw DataError(
          fmt::format("{}: the file name does not say where its time is; expected one * there, as "
                      "in cam0/data/*.png, and no other * or ? or number",
                      pattern.string()));
    }
    before = name.substr(0, star);
    after = name.substr(star + 1);
  }
  fs::path with(const std::string& time) const { return folder / (before + time + after); }
};

std::vector<NamedPicture> find_pictures(const fs::path& pattern, TimeUnit unit) {
  const NamePattern parts(pattern);
  std::vector<NamedPicture> pictures;
  for (const fs::path& file : glob(pattern)) {
    std::string time = file.filename().string();
    time = time.substr(parts.before.size(), time.size() - parts.before.size() - parts.after.size());
    const Stamp stamp = parse_stamp(time, unit, file.string());
    pictures.push_back({stamp, std::move(time), file});
  }
  std::ranges::sort(pictures, {}, &NamedPicture::stamp);
  const auto same = std::ranges::adjacent_find(pictures, {}, &NamedPicture::stamp);
  if (same != pictures.end()) {
    throw DataError(fmt::format("{} and {} have the same time; expected one image for each time",
                                same->file.string(), (same + 1)->file.filename().string()));
  }
  return pictures;
}

std::vector<Stamp> stamps_of(const std::vector<NamedPicture>& pictures) {
  std::vector<Stamp> stamps;
  for (const NamedPicture& picture : pictures) stamps.push_back(picture.stamp);
  return stamps;
}

/// Returns the name's time of the picture that gave a frame its time.
const std::string& text_of(const TimedFrame& frame,
                           const std::vector<std::vector<NamedPicture>>& layers) {
  std::size_t layer = 0;
  while (!frame.pictures[layer]) ++layer;
  return layers[layer][*frame.pictures[layer]].text;
}

/// Throws DataError if no frame has pictures of both layers.
void require_partners(const std::vector<std::vector<NamedPicture>>& layers, std::size_t layer,
                      const std::vector<TimedFrame>& frames, const std::vector<fs::path>& patterns,
                      double tolerance) {
  const bool some = std::ranges::any_of(
      frames, [&](const TimedFrame& frame) { return frame.pictures[0] && frame.pictures[layer]; });
  if (some) return;
  const std::string pair = fmt::format("{} and {}", patterns[0].string(), patterns[layer].string());
  if (layers[0].empty() || layers[layer].empty())
    throw DataError(fmt::format("{} find {} and {} images; expected some of both", pair,
                                layers[0].size(), layers[layer].size()));
  std::vector<double> apart;
  const std::vector<Stamp> others = stamps_of(layers[layer]);
  for (const NamedPicture& p : layers[0])
    apart.push_back(1e3 *
                    std::abs(seconds_between(p.stamp, others[nearest_in_time(others, p.stamp)])));
  throw DataError(
      fmt::format("{} have no two images within {:g} ms of each other; the nearest are {:.6g} ms "
                  "apart in the median. Expected times of one clock; if they are, give the largest "
                  "difference within a frame in timestamps.tolerance_ms",
                  pair, 1e3 * tolerance, upper_median(std::move(apart))));
}

TimedImages stamped_names(const std::vector<fs::path>& patterns, const Selection& selection,
                          const TimestampSettings& settings) {
  std::vector<std::vector<NamedPicture>> layers;
  for (const fs::path& pattern : patterns) layers.push_back(find_pictures(pattern, *settings.unit));
  const auto none = [](const auto& layer) { return layer.empty(); };
  if (std::ranges::all_of(layers, none)) nothing_found(patterns);
  std::vector<std::vector<Stamp>> stamps;
  for (const auto& layer : layers) stamps.push_back(stamps_of(layer));
  const std::vector<TimedFrame> frames =
      pair_by_time(stamps, std::llround(1e9 * settings.tolerance));
  for (std::size_t i = 1; i < layers.size(); ++i)
    require_partners(layers, i, frames, patterns, settings.tolerance);

  TimedImages out;
  out.images = {std::vector<ImageList>(layers.size()), selection.start.value_or(0), 0,
                static_cast<int>(frames.size()) - 1};
  for (const std::size_t k : positions(selection, frames.size(), patterns[0])) {
    out.stamps.push_back(frames[k].time);
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const std::optional<std::size_t> picture = frames[k].pictures[i];
      out.images.views[i].push_back(
          picture ? layers[i][*picture].file
                  : NamePattern(patterns[i]).with(text_of(frames[k], layers)));
    }
  }
  return out;
}

/// Returns the times of the frames from those of all images of the recording.
std::vector<Stamp> of_frames(const std::vector<Stamp>& all, const Images& images, int step,
                             const std::string& file) {
  const std::int64_t count = std::int64_t{images.highest} - images.lowest + 1;
  if (std::ssize(all) != count) {
    throw DataError(
        fmt::format("{}: has {} times; expected {}, one for each image from number {} to {}, "
                    "missing numbers included",
                    file, all.size(), count, images.lowest, images.highest));
  }
  std::vector<Stamp> stamps;
  for (std::size_t i = 0; i < images.views[0].size(); ++i) {
    const std::int64_t number = images.first + static_cast<std::int64_t>(i) * step;
    if (number < images.lowest || number > images.highest) {
      throw DataError(
          fmt::format("{}: has no time for image {}; expected `start` and `count` to stay within "
                      "the images that exist, {} to {}",
                      file, number, images.lowest, images.highest));
    }
    stamps.push_back(all[static_cast<std::size_t>(number - images.lowest)]);
  }
  return stamps;
}

}  // namespace

TimedImages find_timed_images(const std::vector<fs::path>& patterns, const Selection& selection,
                              const TimestampSettings& settings) {
  if (settings.from == TimestampOrigin::names) return stamped_names(patterns, selection, settings);
  TimedImages out{find_images(patterns, selection), {}};
  if (settings.given()) {
    out.stamps =
        of_frames(read_stamps(settings), out.images, selection.step, settings.file.string());
  }
  return out;
}

std::string note_on_names(const ImageList& images) {
  if (images.size() < 2) return {};
  const auto unit = unit_of_name(images.front().stem().string());
  if (!unit || unit != unit_of_name(images.back().stem().string())) return {};
  return fmt::format(
      "{}: the name looks like a time, which is not read: frames get times of a constant rate. Set "
      "`timestamps: {{from: names, unit: {}}}` to use it",
      images.front().string(), enum_names(*unit)[static_cast<std::size_t>(*unit)]);
}

}  // namespace hypotrack
