#include "hand_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "hand_proportions.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/shape.hpp"

namespace hypotrack {
namespace {

constexpr std::array<std::string_view, 5> kAllFingers = {"thumb", "index", "middle", "ring",
                                                         "little"};

// Standard deviations among adults. In ANSUR II, with equal shares of men and women, the palm's
// length varies by 6.4 %, hand breadth over it by 5.9 % and the middle finger's length over it by
// 8.2 % (C. C. Gordon et al., "2012 Anthropometric Survey of U.S. Army Personnel: Methods and
// Summary Statistics", NATICK/TR-15/007). 7 % for the size allows for a neutral hand that is not
// the mean one. Both lengths of the third ratio end at a crease, which is found to some millimetres
// only. Finger lengths themselves vary by 6 to 8 % (Chatzioglou, Pinar and Govsa, "Biometric
// analysis hand parameters in young adults", Anat. Cell Biol. 57(2), 2024: 63.9 +- 4.1, 70.7
// +- 5.2, 65.5 +- 4.8 and 53.3 +- 4.3 mm), which leaves 6.5 % over the palm. Width is assumed to
// vary as breadth does, the thumb as fingers do. hand_proportions.cpp has the correlations. The
// bounds are at 4 to 5 deviations.
constexpr double kSizeDeviation = 0.07, kFingerDeviation = 0.065, kWidthDeviation = 0.06;
constexpr double kSmallest = 0.7, kLargest = 1.35;
constexpr double kShortest = 0.75, kLongest = 1.3;

/// Returns the finger that a parameter turns, as an index into kAllFingers; their number if it is
/// none.
std::size_t finger_of(const std::string& parameter) {
  std::size_t f = 0;
  while (f < kAllFingers.size() && !parameter.starts_with(std::string(kAllFingers[f]) + '_')) ++f;
  return f;
}

/// Returns the stretches of the fingers' bones: the bones that their angles turn, and their
/// descendants.
std::vector<BoneStretch> stretches_of(const ModelData& hand, const HandShape& shape) {
  std::vector<const Parameter*> driver(hand.bones.size(), nullptr);
  for (const BoneMotion& r : hand.motions) {
    driver[static_cast<std::size_t>(r.bone)] =
        &hand.parameters[static_cast<std::size_t>(r.parameter)];
  }
  std::vector<BoneStretch> stretches(hand.bones.size());
  std::vector<bool> in_finger(hand.bones.size(), false);
  for (std::size_t i = 0; i < hand.bones.size(); ++i) {
    const int parent = hand.bones[i].parent;
    if (parent >= 0 && in_finger[static_cast<std::size_t>(parent)]) {
      stretches[i] = {stretches[static_cast<std::size_t>(parent)].factors, false};
      in_finger[i] = true;
    } else if (driver[i] != nullptr) {
      const std::size_t finger = finger_of(driver[i]->name);
      if (finger == kAllFingers.size()) continue;
      stretches[i] = {{shape.width, shape.lengths[finger], shape.width}, true};
      in_finger[i] = true;
    }
  }
  return stretches;
}

}  // namespace

const std::vector<ShapeParameter>& hand_shape_parameters() {
  static const std::vector<ShapeParameter> parameters = [] {
    std::vector<ShapeParameter> all = {{"scale", 1, 1, kSmallest, kLargest, kSizeDeviation}};
    for (const std::string_view finger : kAllFingers)
      all.push_back({std::string(finger), 1, 1, kShortest, kLongest, kFingerDeviation});
    all.push_back({"width", 1, 1, kShortest, kLongest, kWidthDeviation});
    correlate_as_people(all);
    return all;
  }();
  return parameters;
}

HandShape hand_shape(std::span<const double> values) {
  const std::size_t expected = hand_shape_parameters().size();
  if (values.size() != expected) {
    throw Error(fmt::format("hand: a shape has {} numbers, expected {}", values.size(), expected));
  }
  HandShape shape;
  shape.scale = values.front();
  std::copy_n(values.begin() + 1, kAllFingers.size(), shape.lengths.begin());
  shape.width = values.back();
  return shape;
}

void build(ModelData& hand, const HandShape& shape) {
  const auto is_one = [](double factor) { return factor == 1; };
  if (shape.width != 1 || !std::all_of(shape.lengths.begin(), shape.lengths.end(), is_one))
    stretch_bones(hand, stretches_of(hand, shape));
  if (shape.scale != 1) scale_model(hand, shape.scale);
}

std::array<double, 5> finger_lengths(const std::vector<double>& factors, const std::string& where) {
  std::array<double, 5> lengths = {1, 1, 1, 1, 1};
  if (factors.size() == 1) lengths.fill(factors[0]);
  if (factors.size() == lengths.size()) std::copy(factors.begin(), factors.end(), lengths.begin());
  if (factors.size() > 1 && factors.size() != lengths.size()) {
    throw ConfigError(
        fmt::format("{}: finger_scale has {} numbers, expected one for all fingers or five: thumb, "
                    "index, middle, ring, little",
                    where, factors.size()));
  }
  return lengths;
}

}  // namespace hypotrack
