// Correspondence lines: histograms, distributions, places between pixels.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "color_histograms.hpp"
#include "correspondence_lines.hpp"
#include "line_distribution-inl.hpp"
#include "line_places.hpp"

namespace hypotrack::contour {
namespace {

const cv::Vec3b kOn(60, 70, 200), kBeside(190, 160, 80);

/// Returns a picture whose left part shows `on` up to x = edge, with the mixture where it ends.
cv::Mat3b edge_at(double edge, const cv::Vec3b& on = kOn, const cv::Vec3b& beside = kBeside) {
  cv::Mat3b out(60, 60);
  for (int x = 0; x < 60; ++x) {
    const double share = std::clamp(edge - (x - 0.5), 0.0, 1.0);
    cv::Vec3b color;
    for (int c = 0; c < 3; ++c)
      color[c] = cv::saturate_cast<uchar>(share * on[c] + (1 - share) * beside[c]);
    out.col(x).setTo(color);
  }
  return out;
}

/// Returns a picture all of whose pixels are valid.
cv::Mat4b with_alpha(const cv::Mat3b& color) {
  cv::Mat4b out;
  cv::cvtColor(color, out, cv::COLOR_BGR2BGRA);
  return out;
}

float odds_of(const ColorHistograms& colors, const cv::Vec3b& color) {
  return colors.log_odds()[ColorHistograms::bin_of(color)];
}

ColorHistograms learned(const cv::Vec3b& on = kOn, const cv::Vec3b& beside = kBeside) {
  ColorHistograms out;
  for (int i = 0; i < 2000; ++i) {
    out.count(on, true);
    out.count(beside, false);
  }
  out.learn(1);
  return out;
}

/// Returns the line across the edge at x = 30 of a picture.
CorrespondenceLine line_in(const cv::Mat3b& color, int scale, const ColorHistograms& colors) {
  const TileCamera camera{60, 60, 100, 100, 0, 0, Eigen::Isometry3d::Identity()};
  const RegionView view{&camera, {with_alpha(color), colors.log_odds()}};
  const ContourPoint point{
      {0.3f, 0.3f, 1}, Eigen::Vector3f(1, 0, -0.3f).normalized(), {0, 0, 0}, {0, 0, 0}, 1, 1};
  const auto lines = find_lines({&point, 1}, Eigen::Isometry3f::Identity(), view, scale);
  EXPECT_EQ(lines.size(), 1u);
  return lines.at(0);
}

TEST(Colors, AreTheModelsWhereTheyWereSeenOnIt) {
  const ColorHistograms colors = learned();
  EXPECT_GT(odds_of(colors, kOn), 5);
  EXPECT_LT(odds_of(colors, kBeside), -5);
  EXPECT_EQ(odds_of(colors, {0, 255, 0}), 0);  // never seen
}

TEST(Colors, OfOneSideOnlyTeachNothing) {
  ColorHistograms colors;
  colors.count(kOn, true);
  colors.learn(1);
  EXPECT_TRUE(colors.is_empty());
}

TEST(Colors, OfLaterFramesAreMixedIn) {
  ColorHistograms colors = learned();
  for (int i = 0; i < 100; ++i) {
    colors.count(kBeside, true);  // the other way round
    colors.count(kOn, false);
  }
  colors.learn(0.2);
  const float odds = odds_of(colors, kOn);
  EXPECT_NEAR(odds, std::log(0.8 / 0.2), 0.05);
  colors.count(kBeside, true);
  colors.discard();
  colors.learn(0.5);
  EXPECT_EQ(odds_of(colors, kOn), odds);
}

TEST(LineDistribution, FindsTheStepWhereItIs) {
  float before = -6;
  for (int step = -4; step <= 4; ++step) {
    const auto edge = static_cast<float>(step) + 0.5f;
    float likeness[kSegments];
    for (int k = 0; k < kSegments; ++k) likeness[k] = from_middle(k) < edge ? 0.95f : -0.95f;
    const Place place = scalar::find_place(likeness);
    if (std::abs(step) < 3) {  // cut off at the line's ends
      EXPECT_NEAR(place.mean, edge, 0.2);
    }
    EXPECT_GT(place.mean, before + 0.5f);
    EXPECT_LT(place.variance, 4);
    before = place.mean;
  }
}

TEST(LineDistribution, IsWideWhereColorsSayNothing) {
  const float likeness[kSegments] = {};
  const Place place = scalar::find_place(likeness);
  EXPECT_NEAR(place.mean, 0, 1e-5);
  EXPECT_NEAR(place.variance, (12.0 * 12 - 1) / 12, 1e-3);  // uniform over 12 places
}

TEST(Line, OfLongSegmentsReachesFar) {
  for (const double edge : {18.0, 25.0, 37.0, 44.0}) {
    const CorrespondenceLine line = line_in(edge_at(edge), 4, learned());
    EXPECT_NEAR(line.mean, edge - 30, 2);
    EXPECT_EQ(line.normal, Eigen::Vector2f(1, 0));
    EXPECT_NEAR(line.centre.x(), 30, 1e-4);
  }
}

TEST(Line, FindsEdgesBetweenPixels) {
  for (double edge = 28.5; edge < 31.5; edge += 0.21)
    EXPECT_NEAR(line_in(edge_at(edge), 1, learned()).mean, edge - 30, 0.2) << edge;
}

TEST(Line, IsNotPulledInwardsByMixturesThatTheGroundHasToo) {
  ColorHistograms colors = learned();
  const cv::Vec3b mixture = (kOn + kBeside) / 2;
  for (int i = 0; i < 200; ++i) colors.count(mixture, false), colors.count(kOn, true);
  colors.learn(0.5);
  double off = 0;
  int count = 0;
  for (double edge = 28.5; edge < 31.5; edge += 0.21, ++count)
    off += line_in(edge_at(edge), 1, colors).mean - (edge - 30);
  EXPECT_NEAR(off / count, 0, 0.1);
}

TEST(Line, OfLittleContrastKeepsThePlaceOfItsHistograms) {
  const cv::Vec3b on(100, 100, 100), beside(118, 100, 100);  // in neighbouring bins
  // The mixture of pixel 31 is in the model's bin.
  EXPECT_NEAR(line_in(edge_at(31.2, on, beside), 1, learned(on, beside)).mean, 1.5, 0.1);
  const cv::Vec3b clear(160, 100, 100);
  EXPECT_NEAR(line_in(edge_at(31.2, on, clear), 1, learned(on, clear)).mean, 1.2, 0.1);
}

TEST(Line, IsLessSureWhereBothWaysDisagree) {
  const cv::Mat3b picture = edge_at(30);
  ColorHistograms misled = learned();
  for (int i = 0; i < 4000; ++i) {
    misled.count(picture(30, 30), true);  // the mixture
    misled.count(kBeside, false);
  }
  misled.learn(0.5);
  cv::Mat3b wide = picture.clone();
  for (const int x : {31, 32}) wide.col(x).setTo(picture(30, 30));
  EXPECT_GT(line_in(wide, 1, misled).variance, line_in(picture, 1, learned()).variance + 0.5f);
}

TEST(Line, BehindColoursNeverSeenIsLeftOut) {
  const cv::Mat3b picture = edge_at(30, {0, 255, 0});
  const ColorHistograms colors = learned();
  const TileCamera camera{60, 60, 100, 100, 0, 0, Eigen::Isometry3d::Identity()};
  const RegionView view{&camera, {with_alpha(picture), colors.log_odds()}};
  const ContourPoint point{{0.3f, 0.3f, 1}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0}, 1, 1};
  EXPECT_TRUE(find_lines({&point, 1}, Eigen::Isometry3f::Identity(), view, 1).empty());
}

TEST(Line, DoesNotLookBesideTheCamerasPicture) {
  cv::Mat4b picture = with_alpha(edge_at(30));
  const ColorHistograms colors = learned();
  Place all, cut;
  const PixelLine line{{30, 30}, {1, 0}};
  find_places({picture, colors.log_odds()}, {&line, 1}, 2, {&all, 1});
  picture.colRange(31, 60).setTo(cv::Scalar::all(0));  // not even the colours of the ground
  find_places({picture, colors.log_odds()}, {&line, 1}, 2, {&cut, 1});
  EXPECT_GT(cut.variance, all.variance + 1);
}

TEST(Line, BehindAnotherModelIsLeftOut) {
  const TileCamera camera{60, 60, 100, 100, 0, 0, Eigen::Isometry3d::Identity()};
  const ColorHistograms colors = learned();
  const ContourPoint point{{0.3f, 0.3f, 1}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0}, 1, 1};
  RegionView view{&camera, {with_alpha(edge_at(30)), colors.log_odds()}};
  view.nearest = cv::Mat1f(60, 60, 0.8f);
  const auto count = [&](float distance) {
    view.distance = distance;
    return find_lines({&point, 1}, Eigen::Isometry3f::Identity(), view, 1).size();
  };
  EXPECT_EQ(count(1), 0u);
  EXPECT_EQ(count(0.8f), 1u);  // it is the nearest one itself
}

TEST(Cover, ReachesThreePixelsBeyondTheHullAndNotBehindNearerModels) {
  const TileCamera camera{60, 60, 100, 100, 0, 0, Eigen::Isometry3d::Identity()};
  std::vector<ContourPoint> square;
  for (const float x : {0.2f, 0.4f})
    for (const float y : {0.1f, 0.3f})
      square.push_back({{x, y, 1}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0}, 1, 1});
  cv::Mat1f nearest(60, 60, 2.0f);
  nearest.rowRange(0, 15) = 0.5f;
  add_cover(square, Eigen::Isometry3f::Identity(), camera, 1, nearest);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) {
      const bool covered = x >= 17 && x <= 43 && y >= 7 && y <= 33;
      EXPECT_EQ(nearest(y, x), y < 15 ? 0.5f : covered ? 1 : 2) << x << " " << y;
    }
  square.resize(1);
  square[0].position = {90, 90, 1};  // far beside the picture
  add_cover(square, Eigen::Isometry3f::Identity(), camera, 0.1f, nearest);
  EXPECT_GE(*std::ranges::min_element(nearest), 0.5f);
}

TEST(Extent, IsThatOfATileOfTheModelAlone) {
  const TileCamera camera{400, 400, 800, 800, 200, 200, Eigen::Isometry3d::Identity()};
  const ContourPoint point{{0.05f, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0}, 1, 1};
  const ContourViews model({0, 0, 0}, sphere_directions(0), std::vector<std::uint32_t>(13, 0),
                           {point});
  const auto at = [&](float z) {
    return extent_of(model, Eigen::Isometry3f(Eigen::Translation3f(0, 0, z)), camera);
  };
  EXPECT_NEAR(at(1), 1.5 * 2 * 0.05 * 800, 0.1);
  EXPECT_EQ(at(0.1f), 400);
  EXPECT_EQ(at(-1), 400);
}

TEST(Line, AcrossAThinPartIsLeftOut) {
  const TileCamera camera{60, 60, 100, 100, 0, 0, Eigen::Isometry3d::Identity()};
  const ColorHistograms colors = learned();
  const RegionView view{&camera, {with_alpha(edge_at(30)), colors.log_odds()}};
  const auto count = [&](float inside, float outside, int scale) {
    const ContourPoint point{{0.3f, 0.3f, 1}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0}, inside, outside};
    return find_lines({&point, 1}, Eigen::Isometry3f::Identity(), view, scale).size();
  };
  EXPECT_EQ(count(0.05f, 1, 1), 1u);
  EXPECT_EQ(count(0.05f, 1, 4), 0u);
  EXPECT_EQ(count(1, 0.02f, 1), 0u);
}

TEST(Line, OfAnEdgeThatIsNoLongerTheOutlineIsNotSeen) {
  const TileCamera camera{60, 60, 100, 100, 0, 0, Eigen::Isometry3d::Identity()};
  ContourPoint point{{0.3f, 0.3f, 1}, {1, 0, 0}, {0, 0, -1}, {1, 0, 0}, 1, 1};
  const auto is_seen = [&] {
    return seen(point, Eigen::Isometry3f::Identity(), camera).has_value();
  };
  EXPECT_TRUE(is_seen());
  point.back = {-1, 0, 0};  // both sides face the camera
  EXPECT_FALSE(is_seen());
  point.front = {1, 0, 0};  // neither does
  point.back = {0, 0, 1};
  EXPECT_FALSE(is_seen());
  point.front = point.back = {0, 0, 0};  // nothing is known
  EXPECT_TRUE(is_seen());
}

}  // namespace
}  // namespace hypotrack::contour
