#include "timed_images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include "hypotrack/error.hpp"
#include "hypotrack/median.hpp"

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

/// The pictures of one frame.
struct StampedFrame {
  Stamp stamp;
  std::string text;             ///< of the picture that gave the stamp
  std::vector<fs::path> files;  ///< by layer; empty: not there
};

/// Returns the index of the nearest in time, the earlier of two. `all` must ascend, and not be
/// empty.
template <class T>
std::size_t nearest(const std::vector<T>& all, Stamp stamp) {
  const auto after = std::ranges::lower_bound(all, stamp, {}, &T::stamp);
  const auto index = static_cast<std::size_t>(after - all.begin());
  if (index == 0) return 0;
  if (index == all.size()) return index - 1;
  return stamp - all[index - 1].stamp <= all[index].stamp - stamp ? index - 1 : index;
}

/// Adds the pictures of a layer to the frames that they belong to, or as new frames.
void add_layer(std::vector<StampedFrame>& frames, const std::vector<NamedPicture>& pictures,
               std::size_t layer, std::size_t layers, Stamp tolerance) {
  std::vector<StampedFrame> alone;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const NamedPicture& picture = pictures[i];
    const std::size_t k = frames.empty() ? 0 : nearest(frames, picture.stamp);
    if (!frames.empty() && std::abs(frames[k].stamp - picture.stamp) <= tolerance &&
        nearest(pictures, frames[k].stamp) == i) {
      frames[k].files[layer] = picture.file;
      continue;
    }
    alone.push_back({picture.stamp, picture.text, std::vector<fs::path>(layers)});
    alone.back().files[layer] = picture.file;
  }
  frames.insert(frames.end(), alone.begin(), alone.end());
  std::ranges::sort(frames, {}, &StampedFrame::stamp);
}

/// Throws DataError if no frame has pictures of both layers.
void require_partners(const std::vector<std::vector<NamedPicture>>& layers, std::size_t layer,
                      const std::vector<StampedFrame>& frames,
                      const std::vector<fs::path>& patterns, double tolerance) {
  const bool some = std::ranges::any_of(frames, [&](const StampedFrame& frame) {
    return !frame.files[0].empty() && !frame.files[layer].empty();
  });
  if (some) return;
  const std::string pair = fmt::format("{} and {}", patterns[0].string(), patterns[layer].string());
  if (layers[0].empty() || layers[layer].empty())
    throw DataError(fmt::format("{} find {} and {} images; expected some of both", pair,
                                layers[0].size(), layers[layer].size()));
  std::vector<double> apart;
  for (const NamedPicture& p : layers[0]) {
    const Stamp other = layers[layer][nearest(layers[layer], p.stamp)].stamp;
    apart.push_back(1e3 * std::abs(seconds_between(p.stamp, other)));
  }
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
  std::vector<StampedFrame> frames;
  const Stamp tolerance = std::llround(1e9 * settings.tolerance);
  for (std::size_t i = 0; i < layers.size(); ++i)
    add_layer(frames, layers[i], i, layers.size(), tolerance);
  for (std::size_t i = 1; i < layers.size(); ++i)
    require_partners(layers, i, frames, patterns, settings.tolerance);

  TimedImages out;
  out.images = {std::vector<ImageList>(layers.size()), selection.start.value_or(0), 0,
                static_cast<int>(frames.size()) - 1};
  for (const std::size_t k : positions(selection, frames.size(), patterns[0])) {
    out.stamps.push_back(frames[k].stamp);
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const fs::path& file = frames[k].files[i];
      out.images.views[i].push_back(file.empty() ? NamePattern(patterns[i]).with(frames[k].text)
                                                 : file);
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
