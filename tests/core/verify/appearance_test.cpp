#include "track/verify/appearance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "painted_box.hpp"

namespace hypotrack {
namespace {

class AppearanceTest : public testing::Test {
 protected:
  SurfaceSamples at(const Eigen::VectorXd& state) {
    SurfaceSampler sampler(box_.scene, 0, box_.cameras);
    return sampler.sample(box_.frame(), state, {});
  }
  /// The box turned by half a turn about an axis of its own.
  Eigen::VectorXd turned(const Eigen::Vector3d& axis) const {
    Eigen::VectorXd out = box_.state();
    out.segment<4>(3) << 0, axis;
    return out;
  }

  test::PaintedBox box_;
  Appearance appearance_;
};

TEST_F(AppearanceTest, IsUnknownBeforeAnythingWasLearned) {
  EXPECT_TRUE(std::isnan(appearance_.likeness(at(box_.state()))));
}

TEST_F(AppearanceTest, APoseThatIsRightLooksLikeBefore) {
  appearance_.learn(at(box_.state()));
  EXPECT_GT(appearance_.likeness(at(box_.state())), 0.85);
}

TEST_F(AppearanceTest, ATurnedBoxDoesNotThoughItsSilhouetteFits) {
  appearance_.learn(at(box_.state()));
  EXPECT_LT(appearance_.likeness(at(turned({0, 0, 1}))), 0.5);
}

TEST_F(AppearanceTest, MillimetresAreForgiven) {
  appearance_.learn(at(box_.state()));
  EXPECT_GT(appearance_.likeness(at(box_.state(0.004))), 0.8);
}

TEST_F(AppearanceTest, ExpectedColoursAreComparedOnAllSides) {
  const SurfaceSamples samples = at(box_.state());
  std::vector<cv::Vec3f> colors;
  for (const SurfaceSamples::Point& point : samples.points)
    colors.push_back(samples.views[0].color(point.at));
  appearance_.expect(colors);
  EXPECT_GT(appearance_.likeness(samples), 0.85);
  EXPECT_LT(appearance_.likeness(at(turned({0, 0, 1}))), 0.5);
  EXPECT_FALSE(std::isnan(appearance_.likeness(at(turned({0, 1, 0})))));
}

TEST_F(AppearanceTest, OfASideNeverSeenNothingIsKnown) {
  appearance_.learn(at(box_.state()));
  EXPECT_TRUE(std::isnan(appearance_.likeness(at(turned({0, 1, 0})))));
}

}  // namespace
}  // namespace hypotrack
