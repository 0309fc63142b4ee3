#include "hand_proportions.hpp"

#include <string_view>
#include <utility>

namespace hypotrack {
namespace {

// Correlations with the palm's length, which is the scale, and with each other of the lengths of
// middle finger and hand breadth over that of the palm. Computed from the logarithms of hand
// length, palm length and hand breadth of the 4,082 men and 1,986 women of ANSUR II, weighted to
// equal shares (C. C. Gordon et al., "2012 Anthropometric Survey of U.S. Army Personnel: Methods
// and Summary Statistics", NATICK/TR-15/007). The middle finger is hand length less palm length.
// Other fingers are assumed to vary as it does, the thickness of fingers as breadth.
constexpr double kScaleFinger = -0.30, kScaleWidth = -0.19, kFingerWidth = 0.38;
// Index over ring finger varies by 3.3 % (P. Branas-Garza, University of Granada: 80 % of 574 women
// between 0.926 and 1.011). That leaves this much between two lengths that vary by 6.5 % each.
constexpr double kFingers = 0.87;
// Thumbs have no source. They are assumed to follow fingers less than fingers do each other.
constexpr double kThumbFinger = 0.6;

enum class Kind { scale, thumb, finger, width, other };

Kind kind_of(std::string_view name) {
  if (name == "scale") return Kind::scale;
  if (name == "thumb") return Kind::thumb;
  if (name == "width") return Kind::width;
  for (const std::string_view finger : {"index", "middle", "ring", "little"})
    if (name == finger) return Kind::finger;
  return Kind::other;
}

double correlation(Kind a, Kind b) {
  if (a > b) std::swap(a, b);
  if (b == Kind::other) return 0;
  if (a == Kind::scale) return b == Kind::width ? kScaleWidth : kScaleFinger;
  if (b == Kind::width) return kFingerWidth;
  return a == Kind::thumb ? kThumbFinger : kFingers;
}

}  // namespace

void correlate_as_people(std::span<ShapeParameter> parameters) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    parameters[i].correlations.clear();
    for (const ShapeParameter& earlier : parameters.first(i))
      parameters[i].correlations.push_back(
          correlation(kind_of(parameters[i].name), kind_of(earlier.name)));
  }
}

}  // namespace hypotrack
