// Places of many lines at once, on every instruction set.
#include "line_places.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "color_histograms.hpp"
#include "every_target.hpp"

namespace hypotrack::contour {
namespace {

const cv::Vec3b kModel(60, 70, 200), kGround(190, 160, 80);

/// A picture of a model left of x = 30, and colours that were learned from it.
struct LinesAcrossAnEdge : testing::Test {
  LinesAcrossAnEdge() : picture(60, 60, cv::Vec4b(kGround[0], kGround[1], kGround[2], 255)) {
    picture.colRange(0, 30) = cv::Scalar(kModel[0], kModel[1], kModel[2], 255);
    for (int i = 0; i < 2000; ++i) {
      colors.count(kModel, true);
      colors.count(kGround, false);
    }
    colors.learn(1);
    for (int i = 0; i < 37; ++i)  // no whole number of vectors
      lines.push_back({{27 + 0.17f * static_cast<float>(i), 12 + static_cast<float>(i)},
                       Eigen::Vector2f(1, 0.02f * static_cast<float>(i)).normalized()});
  }
  std::vector<Place> places_of(std::span<const PixelLine> of, int scale) const {
    std::vector<Place> out(of.size());
    find_places({picture, colors.log_odds()}, of, scale, out);
    return out;
  }

  cv::Mat4b picture;
  ColorHistograms colors;
  std::vector<PixelLine> lines;
};

TEST_F(LinesAcrossAnEdge, HaveTheSamePlacesAloneAsTogether) {
  for (const int scale : {1, 3}) {
    const std::vector<Place> together = places_of(lines, scale);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const Place alone = places_of({&lines[i], 1}, scale).front();
      EXPECT_EQ(alone.mean, together[i].mean);
      EXPECT_EQ(alone.variance, together[i].variance);
    }
  }
}

TEST_F(LinesAcrossAnEdge, HaveTheSamePlacesOnEveryInstructionSet) {
  for (const int scale : {1, 3}) {
    const std::vector<Place> usual = places_of(lines, scale);
    test::on_every_target(compiled_targets(), [&] {
      const std::vector<Place> found = places_of(lines, scale);
      for (std::size_t i = 0; i < lines.size(); ++i) {
        EXPECT_NEAR(found[i].mean, usual[i].mean, 1e-3);
        EXPECT_NEAR(found[i].variance, usual[i].variance, 1e-3 * double{usual[i].variance});
      }
    });
  }
}

}  // namespace
}  // namespace hypotrack::contour
