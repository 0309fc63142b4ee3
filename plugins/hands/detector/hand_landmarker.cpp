#include "hand_landmarker.hpp"

#include <cmath>
#include <span>
#include <vector>

namespace hypotrack::hands {
namespace {

constexpr int kHandSide = 224;  // pixels of the network's picture
constexpr std::size_t kPointNumbers = 63;
constexpr double kNothing = 0.02;  // a presence at which landmarks lead nowhere

using Points = Eigen::Matrix<double, 3, 21>;

Points points_of(const std::vector<float>& numbers) {
  return Eigen::Map<const Eigen::Matrix<float, 3, 21>>(numbers.data()).cast<double>();
}

/// Returns whether a network can look there: a damaged one, or a wrong guess, may lead anywhere.
bool usable(const Region& region) {
  constexpr double kLargest = 1e6;
  return region.center.allFinite() && region.center.cwiseAbs().maxCoeff() < kLargest &&
         region.side > 1 && region.side < kLargest && std::isfinite(region.angle);
}

}  // namespace

HandLandmarker::HandLandmarker(const std::filesystem::path& file)
    : network_(file, kHandSide,
               {{"landmarks", kPointNumbers},
                {"presence", 1},
                {"right", 1},
                {"relative", kPointNumbers}}) {}

HandDetection HandLandmarker::find(const HandPicture& picture, Region region, const Rounds& rounds,
                                   int threads) const {
  HandDetection out;
  for (int i = 0; i < rounds.most; ++i) {
    if (!usable(region)) return {};
    out = find_once(picture, region, threads);
    const Region next = region_of(out.landmarks);
    if (out.presence < kNothing || nearly_equal(region, next, rounds.share)) break;
    region = next;
  }
  return out;
}

HandDetection HandLandmarker::find_once(const HandPicture& picture, const Region& region,
                                        int threads) const {
  const auto outputs = network_.run(
      [&](std::span<float> input) { write_region(picture, region, kHandSide, input); }, threads);
  const Eigen::Matrix2d rotation = rotation_of(region);
  const Eigen::Matrix2Xd in_cut = points_of(outputs[0]).topRows<2>();
  HandDetection out;
  out.palm_score = 1;
  out.landmarks =
      (rotation * (region.side / kHandSide) * (in_cut.array() - kHandSide / 2.0).matrix())
          .colwise() +
      region.center;
  out.presence = double{outputs[1][0]};
  out.right = double{outputs[2][0]};
  out.relative = points_of(outputs[3]);
  out.relative.topRows<2>() = rotation * out.relative.topRows<2>().eval();
  return out;
}

}  // namespace hypotrack::hands
