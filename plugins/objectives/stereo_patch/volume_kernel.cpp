#include "volume_kernel.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#define HWY_TARGET_INCLUDE "volume_kernel.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "patch_compare-inl.hpp"
#include "plane_warp-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_patch::HWY_NAMESPACE {

using namespace hypotrack::HWY_NAMESPACE;  // Lanes

/// Writes a row of one plane into the volume: the low halves of its words, and the high halves of
/// those of the plane before.
class RowWriter {
 public:
  HYPOTRACK_PIXEL RowWriter(Volume& volume, int plane, int y)
      : here_(volume.words.data() + static_cast<std::size_t>(y) * volume.row_stride() +
              static_cast<std::ptrdiff_t>(plane) * volume.width),
        before_(plane > 0 ? here_ - volume.width : nullptr) {}

  /// Writes `count` similarities from column x on.
  HYPOTRACK_PIXEL void write(int x, int count, Lanes similarity) const {
    const UintTag tag;
    const auto mask = hn::RebindMask(tag, first_lanes(count).m);
    const auto fraction = hn::BitCast(tag, to_int(similarity * Lanes(65535.0f)).v);
    hn::BlendedStore(fraction, mask, tag, here_ + x);
    if (!before_) return;
    const auto both = hn::Or(hn::LoadU(tag, before_ + x), hn::ShiftLeft<16>(fraction));
    hn::BlendedStore(both, mask, tag, before_ + x);
  }
  HYPOTRACK_PIXEL void clear(int x0, int x1) const { std::fill(here_ + x0, here_ + x1, 0u); }

 private:
  std::uint32_t* here_;
  std::uint32_t* before_;
};

/// Rows `first` to `end` - 1 of the first view.
struct Band {
  int first, end;
};

/// Fills a band of one plane, from the second view warped by that plane.
template <class Comparer>
void fill_plane(const Settings& settings, const PixelPlane<float>& warped, int plane, Band band,
                Comparer& comparer, Volume& volume) {
  const int r = settings.radius;
  const int x0 = std::min(r, volume.width), x1 = std::max(volume.width - r, x0);
  const Lanes sharpness(static_cast<float>(settings.sharpness));
  for (int y = band.first; y < band.end; ++y) {
    const RowWriter out(volume, plane, y);
    if (y < r || y >= volume.height - r) {
      out.clear(0, volume.width);
      continue;
    }
    out.clear(0, x0);
    out.clear(x1, volume.width);
    comparer.start_row(warped, y);
    for (int x = x0; x < x1; x += kLanes) {
      const Lanes s = similarity(comparer.correlation_at(warped, x, y), sharpness);
      out.write(x, std::min(kLanes, x1 - x), s * load(volume.weight.row(y) + x));
    }
  }
}

/// Fills a band of all planes.
template <class Comparer>
void fill_band(const VolumeJob& job, const Settings& settings, Band band, Comparer comparer,
               Volume& volume) {
  PixelPlane<float> warped(volume.width, volume.height);
  const int above = std::max(band.first - settings.radius, 0);
  const int below = std::min(band.end + settings.radius, volume.height);
  for (int plane = 0; plane < volume.planes.count; ++plane) {
    const float w = volume.planes.first + static_cast<float>(plane) * volume.planes.step;
    warp(job, w, above, below, warped);
    fill_plane(settings, warped, plane, band, comparer, volume);
  }
}

/// Fills all planes, with a band of rows per thread.
template <class Comparer>
void fill_with(const VolumeJob& job, const Settings& settings, const Comparer& comparer,
               Volume& volume) {
  const int bands = std::clamp(tbb::this_task_arena::max_concurrency(), 1, volume.height);
  tbb::parallel_for(0, bands, [&](int i) {
    const Band band{i * volume.height / bands, (i + 1) * volume.height / bands};
    fill_band(job, settings, band, comparer, volume);
  });
}

void fill_on_target(const VolumeJob& job, const Settings& settings, Volume& volume) {
  if (settings.measure == Measure::census) {
    fill_with(job, settings, CensusComparer(job.left, settings.radius), volume);
  } else {
    fill_with(job, settings,
              ZnccComparer(job.left, settings.radius, static_cast<float>(settings.variance_floor)),
              volume);
  }
}

}  // namespace hypotrack::stereo_patch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::stereo_patch {

HWY_EXPORT(fill_on_target);

void fill_volume(const VolumeJob& job, const Settings& settings, Volume& volume) {
  HWY_DYNAMIC_DISPATCH(fill_on_target)(job, settings, volume);
}

std::int64_t volume_targets() { return HWY_TARGETS; }

}  // namespace hypotrack::stereo_patch
#endif
