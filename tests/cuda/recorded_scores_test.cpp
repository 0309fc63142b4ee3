// What hypotheses of real searches cost, on the GPU as on the CPU.
//
// Both draw the same pixels with the same depths, to the last bit, as do all of the CPU's
// instruction sets that have a fused multiply-add. On the others rounding moves what is drawn by
// some 1e-5 pixels, and so now and then a pixel reads the colour beside the one that it reads
// elsewhere, or is covered where it is not elsewhere. A best stereo_color score is 700 and more in
// tiles of 256 pixels, where such a pixel is nothing. In tiles of 128 it is 100 to 400, and a
// single pixel can be more than a thousandth of that.
#include <gtest/gtest.h>

#include <sstream>
#include <string_view>
#include <vector>

#include "device.hpp"
#include "every_target.hpp"
#include "recorded_search.hpp"
#include "scene/simd_kernels.hpp"

namespace hypotrack::test {
namespace {

constexpr int kDefaultTile = 128;
constexpr double kLargest = 1e-3, kMean = 5e-5;  ///< differences, relative to the largest cost
constexpr double kPixel = 1;  ///< what one pixel adds to a stereo_color score at most

class RecordedScores : public testing::TestWithParam<RecordedCase> {
 protected:
  /// The largest cost of rgbd_depth is the worst one (its best is near 0), that of stereo_color
  /// the best.
  static void expect_near(const Eigen::VectorXd& found, const Eigen::VectorXd& expected,
                          bool same_pixels) {
    const RecordedCase& c = GetParam();
    const double scale = expected.cwiseAbs().maxCoeff();
    const Eigen::ArrayXd difference = (found - expected).array().abs() / scale;
    const bool few_pixels =
        !same_pixels && c.tile == kDefaultTile && c.objective == std::string_view("stereo_color");
    EXPECT_LT(difference.maxCoeff(), few_pixels ? kPixel / scale : kLargest);
    EXPECT_LT(difference.mean(), kMean);
    std::ostringstream numbers;
    numbers << "largest cost " << scale << ", difference " << difference.maxCoeff() << " at most, "
            << difference.mean() << " in the mean";
    RecordProperty("numbers", numbers.str());
  }
};

TEST_P(RecordedScores, OfASearchFromTheTruthAreTheSameOnEveryInstructionSetOfTheCpu) {
  const RecordedSearch search(GetParam());
  EXPECT_EQ(search.rectified(), GetParam().rig == Rig::rectified);
  ASSERT_EQ(search.states().cols(), 32 * 32);
  EXPECT_LT(search.costs()[0], search.costs().mean());
  EXPECT_EQ(search.costs_on(Backend::cpu), search.costs());
  on_every_target(compiled_simd_targets() & ~HWY_SCALAR,  // that one is slow
                  [&](std::int64_t target) {
                    expect_near(search.costs_on(Backend::cpu), search.costs(),
                                fuses_products_and_sums(target));
                  });
}

TEST_P(RecordedScores, AreTheSameOnTheGpu) {
  SKIP_WITHOUT_DEVICE();
  const RecordedSearch search(GetParam());
  const Eigen::VectorXd gpu = search.costs_on(Backend::cuda);
  expect_near(gpu, search.costs(), fuses_products_and_sums());
  EXPECT_EQ(search.costs_on(Backend::cuda), gpu);
}

std::vector<RecordedCase> every_case() {
  std::vector<RecordedCase> cases;
  for (const char* scene : {"demo", "hand_and_box", "two_hands"}) {
    for (const char* objective : {"stereo_color", "rgbd_depth"}) {
      for (const Rig rig : {Rig::rectified, Rig::general}) {
        for (const int tile : {kDefaultTile, 256}) cases.push_back({scene, objective, rig, tile});
      }
    }
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Of, RecordedScores, testing::ValuesIn(every_case()),
                         [](const auto& c) { return (std::ostringstream() << c.param).str(); });

}  // namespace
}  // namespace hypotrack::test
