// Included once per instruction set: no #pragma once.
#if defined(CONTOUR_LINE_DISTRIBUTION_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTOUR_LINE_DISTRIBUTION_INL_HPP_
#undef CONTOUR_LINE_DISTRIBUTION_INL_HPP_
#else
#define CONTOUR_LINE_DISTRIBUTION_INL_HPP_
#endif

#include "hypotrack/plugin/pixel.hpp"
#include "line_distribution.hpp"

HYPOTRACK_PIXEL_BEGIN();
namespace hypotrack::contour::HYPOTRACK_TARGET {

/// Returns the distribution of the outline's place on a line (or on a line per lane). `likeness`
/// has, for each of the kSegments segments, twice the probability that it shows the model, less 1.
/// Across the outline the expected probability falls as a smoothed step (SRT3D, equation 4).
template <class F>
HYPOTRACK_PIXEL PlaceOf<F> find_place(const F* likeness) {
  using hypotrack::pixel::max;  // the scalar one; that of Lanes is found by its argument
  F sum(0.0f), mean(0.0f), square(0.0f);
  for (int place = 0; place < kSteps; ++place) {
    F likelihood(1.0f);
    for (int i = 0; i < kSupport; ++i)
      likelihood = likelihood * (F(1.0f) + F(kStep[i]) * likeness[place + i]);
    const F x(static_cast<float>(place) - (kSteps - 1) / 2.0f);
    sum = sum + likelihood;
    mean = mean + likelihood * x;
    square = square + likelihood * x * x;
  }
  mean = mean / sum;
  constexpr float kLeastVariance = 0.25f;  // places are a segment apart
  return {mean, max(square / sum - mean * mean, F(kLeastVariance))};
}

}  // namespace hypotrack::contour::HYPOTRACK_TARGET
HYPOTRACK_PIXEL_END();

#endif
