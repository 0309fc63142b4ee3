// Included once per instruction set: no #pragma once.
#if defined(STEREO_PATCH_VOLUME_LOOKUP_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef STEREO_PATCH_VOLUME_LOOKUP_INL_HPP_
#undef STEREO_PATCH_VOLUME_LOOKUP_INL_HPP_
#else
#define STEREO_PATCH_VOLUME_LOOKUP_INL_HPP_
#endif

#include "hypotrack/plugin/stereo_pixels-inl.hpp"
#include "patch_similarity-inl.hpp"
#include "volume.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_patch::HWY_NAMESPACE {

using namespace hypotrack::HWY_NAMESPACE;  // Lanes and the walk

/// Looks up similarities between the planes of a volume.
class VolumeLookup {
 public:
  explicit VolumeLookup(const Volume& volume)
      : volume_(volume),
        first_(volume.planes.first),
        planes_per_unit_(1.0f / volume.planes.step),
        last_(static_cast<float>(volume.planes.count - 1)) {}

  /// Returns the pixels that both views see at a depth between the planes.
  HYPOTRACK_PIXEL LaneMask counting(const StereoPixels& p) const {
    return p.seen && between_planes(position(p), last_);
  }

  /// Returns the similarity where `counts`, arbitrary values elsewhere.
  HYPOTRACK_PIXEL Lanes similarity(const StereoPixels& p, LaneMask counts) const {
    return similarity_at(position(p), p, counts);
  }

  /// Returns the similarity of a surface that is `planes` planes nearer, where `counts`. Clamps to
  /// the first and last plane.
  HYPOTRACK_PIXEL Lanes similarity_beside(const StereoPixels& p, LaneMask counts,
                                          float planes) const {
    const Lanes there = position(p) + Lanes(planes);
    return similarity_at(min(max(there, Lanes(0.0f)), last_), p, counts);
  }

  /// Returns the number of planes per 1/m.
  HYPOTRACK_PIXEL Lanes density() const { return planes_per_unit_; }

 private:
  HYPOTRACK_PIXEL Lanes similarity_at(Lanes position, const StereoPixels& p,
                                      LaneMask counts) const {
    const auto at = plane_share(select(counts, position, Lanes(0.0f)), last_);
    const IntLanes index =
        to_int(at.before) * int_lanes(volume_.width) + to_int(count_from(static_cast<float>(p.x)));
    const WordLanes pair = gather(volume_.row(p.y), index);
    const Lanes before = unorm16_low(pair), after = unorm16_high(pair);
    return mul_add(after - before, at.share, before);
  }

  HYPOTRACK_PIXEL Lanes position(const StereoPixels& p) const {
    return (p.inverse_depth - first_) * planes_per_unit_;
  }

  const Volume& volume_;
  Lanes first_, planes_per_unit_, last_;
};

}  // namespace hypotrack::stereo_patch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
