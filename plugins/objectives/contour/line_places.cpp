#include "line_places.hpp"

#include <algorithm>
#include <limits>

#define HWY_TARGET_INCLUDE "line_places.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "hypotrack/plugin/simd-inl.hpp"
#include "line_distribution-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::contour::HWY_NAMESPACE {
namespace {

using namespace hypotrack::HWY_NAMESPACE;  // Lanes

/// Lines, one per lane.
struct LineLanes {
  Lanes x, y, normal_x, normal_y;
};

/// A colour of 0 to 255 per lane.
struct ColorLanes {
  Lanes blue, green, red;
};

HYPOTRACK_PIXEL ColorLanes operator+(const ColorLanes& a, const ColorLanes& b) {
  return {a.blue + b.blue, a.green + b.green, a.red + b.red};
}
HYPOTRACK_PIXEL ColorLanes operator-(const ColorLanes& a, const ColorLanes& b) {
  return {a.blue - b.blue, a.green - b.green, a.red - b.red};
}
HYPOTRACK_PIXEL ColorLanes operator*(Lanes by, const ColorLanes& a) {
  return {by * a.blue, by * a.green, by * a.red};
}
HYPOTRACK_PIXEL Lanes dot(const ColorLanes& a, const ColorLanes& b) {
  return a.blue * b.blue + a.green * b.green + a.red * b.red;
}

/// The pixels of a view for lookups by lane.
struct Image {
  const std::uint32_t* words;
  int pitch;
  Lanes width, height;

  explicit HYPOTRACK_PIXEL Image(const cv::Mat4b& color)
      : words(reinterpret_cast<const std::uint32_t*>(color.data)),
        pitch(static_cast<int>(color.step / sizeof(std::uint32_t))),
        width(static_cast<float>(color.cols)),
        height(static_cast<float>(color.rows)) {}

  HYPOTRACK_PIXEL WordLanes at(IntLanes column, IntLanes row) const {
    return gather(words, row * int_lanes(pitch) + column);
  }
};

HYPOTRACK_PIXEL IntLanes truncated(Lanes a) { return {hn::ConvertTo(IntTag(), a.v)}; }

template <int kShift>
HYPOTRACK_PIXEL Lanes channel(WordLanes pixel) {
  const auto byte = hn::And(hn::ShiftRight<kShift>(pixel.v), hn::Set(UintTag(), 0xFFu));
  return Lanes(hn::ConvertTo(FloatTag(), hn::BitCast(IntTag(), byte)));
}

HYPOTRACK_PIXEL ColorLanes color_of(WordLanes pixel) {
  return {channel<0>(pixel), channel<8>(pixel), channel<16>(pixel)};
}

/// Returns the histograms' bin of a pixel: four bits of each channel, blue first.
HYPOTRACK_PIXEL IntLanes bin_of(WordLanes pixel) {
  const auto bits = [&](auto shifted, std::uint32_t mask)
                        HWY_ATTR { return hn::And(shifted, hn::Set(UintTag(), mask)); };
  const auto blue = bits(hn::ShiftLeft<4>(pixel.v), 0xF00u);
  const auto green = bits(hn::ShiftRight<8>(pixel.v), 0xF0u);
  const auto red = bits(hn::ShiftRight<20>(pixel.v), 0xFu);
  return {hn::BitCast(IntTag(), hn::Or(hn::Or(blue, green), red))};
}

/// Returns the log odds of the pixels at a place; 0 beside the picture.
HYPOTRACK_PIXEL Lanes log_odds_at(const Image& image, const float* by_bin, Lanes x, Lanes y) {
  const Lanes half(0.5f), column = x + half, row = y + half;
  const LaneMask inside =
      column > Lanes(0.0f) && row > Lanes(0.0f) && column < image.width && row < image.height;
  const WordLanes pixel = image.at(truncated(select(inside, column, Lanes(0.0f))),
                                   truncated(select(inside, row, Lanes(0.0f))));
  const LaneMask shown = inside && channel<24>(pixel) > Lanes(0.0f);
  return select(shown, gather(by_bin, bin_of(pixel)), Lanes(0.0f));
}

/// Sums the log odds of the pixels of each segment.
HYPOTRACK_PIXEL void sum_segments(const Image& image, const float* by_bin, const LineLanes& lines,
                                  int scale, Lanes* sums) {
  const Lanes from(-0.5f * static_cast<float>(kSegments * scale - 1));
  Lanes x = lines.x + from * lines.normal_x, y = lines.y + from * lines.normal_y;
  for (int k = 0; k < kSegments; ++k) {
    sums[k] = Lanes(0.0f);
    for (int i = 0; i < scale; ++i) {
      sums[k] = sums[k] + log_odds_at(image, by_bin, x, y);
      x = x + lines.normal_x;
      y = y + lines.normal_y;
    }
  }
}

/// Returns whether most segments just inside a place show colours that were seen on neither side.
HYPOTRACK_PIXEL LaneMask is_hidden(const Lanes* log_odds, Lanes place) {
  constexpr float kNoEvidence = 1e-4f;
  constexpr float kInside = kSupport / 2;
  Lanes unseen(0.0f);
  for (int k = 0; k < kSegments; ++k) {
    const Lanes off = Lanes(from_middle(k)) - place;
    const LaneMask counts =
        off < Lanes(0.0f) && off >= Lanes(-kInside) && abs(log_odds[k]) < Lanes(kNoEvidence);
    unseen = unseen + select(counts, Lanes(1.0f), Lanes(0.0f));
  }
  return unseen > Lanes(kInside / 2);
}

/// Returns the colour between four pixels, that of the border beyond it.
HYPOTRACK_PIXEL ColorLanes color_at(const Image& image, Lanes x, Lanes y) {
  // A little less than the last pixel, so that there is one behind it.
  constexpr float kLast = 1.001f;
  x = min(max(x, Lanes(0.0f)), image.width - Lanes(kLast));
  y = min(max(y, Lanes(0.0f)), image.height - Lanes(kLast));
  const IntLanes left = truncated(x), top = truncated(y);
  const Lanes u = x - to_float(left), v = y - to_float(top);
  const IntLanes right = left + int_lanes(1), bottom = top + int_lanes(1);
  const ColorLanes a = color_of(image.at(left, top)), b = color_of(image.at(right, top));
  const ColorLanes c = color_of(image.at(left, bottom)), d = color_of(image.at(right, bottom));
  const ColorLanes above = a + u * (b - a), below = c + u * (d - c);
  return above + v * (below - above);
}

/// Mean colour of one side of each line.
struct Side {
  ColorLanes sum;
  Lanes count;

  HYPOTRACK_PIXEL Side() : sum{Lanes(0.0f), Lanes(0.0f), Lanes(0.0f)}, count(0.0f) {}
  HYPOTRACK_PIXEL void add(LaneMask mask, const ColorLanes& color) {
    const Lanes one = select(mask, Lanes(1.0f), Lanes(0.0f));
    sum = sum + one * color;
    count = count + one;
  }
  HYPOTRACK_PIXEL ColorLanes mean() const { return (Lanes(1.0f) / count) * sum; }
};

/// Refines places on lines of one-pixel segments.
HYPOTRACK_PIXEL PlaceOf<Lanes> refined(const Image& image, const LineLanes& lines,
                                       const PlaceOf<Lanes>& place) {
  // Pixels from the first place that tell the colour of a side: beyond the mixed ones, and not so
  // far that the surface looks different.
  constexpr float kFrom = 1.5f, kTo = 6;
  constexpr float kLeastContrast = 30;  // of 8-bit colours; several times the noise
  constexpr float kDisagreement = 3;    // variance per square of the difference of both places
  ColorLanes colors[kSegments];
  Side inside, outside;
  for (int k = 0; k < kSegments; ++k) {
    const Lanes at(from_middle(k)), off = at - place.mean;
    colors[k] = color_at(image, lines.x + at * lines.normal_x, lines.y + at * lines.normal_y);
    inside.add(off < Lanes(-kFrom) && off > Lanes(-kTo), colors[k]);
    outside.add(off > Lanes(kFrom) && off < Lanes(kTo), colors[k]);
  }
  const ColorLanes beside = outside.mean(), contrast = inside.mean() - beside;
  const Lanes square = dot(contrast, contrast), scale = Lanes(1.0f) / square;
  Lanes likeness[kSegments];
  for (int k = 0; k < kSegments; ++k) {
    const Lanes share = scale * dot(contrast, colors[k] - beside);
    likeness[k] = Lanes(2.0f) * min(max(share, Lanes(0.0f)), Lanes(1.0f)) - Lanes(1.0f);
  }
  const Lanes mean = find_place(likeness).mean, apart = mean - place.mean;
  const LaneMask tells = min(inside.count, outside.count) > Lanes(0.0f) &&
                         square >= Lanes(kLeastContrast * kLeastContrast);
  return {select(tells, mean, place.mean),
          select(tells, place.variance + Lanes(kDisagreement) * apart * apart, place.variance)};
}

HYPOTRACK_PIXEL PlaceOf<Lanes> places_of(const Image& image, const float* by_bin,
                                         const LineLanes& lines, int scale) {
  Lanes sums[kSegments], likeness[kSegments];
  sum_segments(image, by_bin, lines, scale, sums);
  for (int k = 0; k < kSegments; ++k)
    likeness[k] = Lanes(2.0f) / (Lanes(1.0f) + exp(-sums[k])) - Lanes(1.0f);
  PlaceOf<Lanes> place = find_place(likeness);
  const LaneMask hidden = is_hidden(sums, place.mean);
  if (scale == 1) place = refined(image, lines, place);
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  place.variance = select(hidden, Lanes(kInfinite), place.variance);
  return place;
}

void find_places(const RegionPixels& pixels, std::span<const PixelLine> lines, int scale,
                 std::span<Place> places) {
  const Image image(pixels.color);
  for (std::size_t first = 0; first < lines.size(); first += kLanes) {
    HWY_ALIGN float x[kLanes], y[kLanes], normal_x[kLanes], normal_y[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i) {
      const PixelLine& line = lines[std::min(first + i, lines.size() - 1)];
      x[i] = line.middle.x(), y[i] = line.middle.y();
      normal_x[i] = line.normal.x(), normal_y[i] = line.normal.y();
    }
    const PlaceOf<Lanes> found = places_of(
        image, pixels.log_odds.data(), {load(x), load(y), load(normal_x), load(normal_y)}, scale);
    HWY_ALIGN float mean[kLanes], variance[kLanes];
    store(found.mean, kLanes, mean);
    store(found.variance, kLanes, variance);
    for (std::size_t i = 0; i < std::min<std::size_t>(kLanes, lines.size() - first); ++i)
      places[first + i] = {mean[i], variance[i]};
  }
}

}  // namespace
}  // namespace hypotrack::contour::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::contour {
namespace {
HWY_EXPORT(find_places);
}  // namespace

void find_places(const RegionPixels& pixels, std::span<const PixelLine> lines, int scale,
                 std::span<Place> places) {
  HWY_DYNAMIC_DISPATCH(find_places)(pixels, lines, scale, places);
}

std::int64_t compiled_targets() { return HWY_TARGETS; }

}  // namespace hypotrack::contour
#endif
