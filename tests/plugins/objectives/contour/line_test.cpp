// Correspondence lines: histograms, distributions, places between pixels.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "color_histograms.hpp"
#include "correspondence_lines.hpp"
#include "line_distribution.hpp"

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

cv::Mat4f with_alpha(const cv::Mat3b& color) {
  cv::Mat4b bytes;
  cv::cvtColor(color, bytes, cv::COLOR_BGR2BGRA);
  return cv::Mat4f(bytes);
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
  const cv::Mat1b valid(60, 60, uchar{255});
  const RegionView view{&camera, with_alpha(color), colors.log_odds(color, valid)};
  const ContourPoint point{
      {0.3f, 0.3f, 1}, Eigen::Vector3f(1, 0, -0.3f).normalized(), {0, 0, 0}, {0, 0, 0}, 1, 1};
  const auto lines = find_lines({&point, 1}, Eigen::Isometry3f::Identity(), view, scale);
  EXPECT_EQ(lines.size(), 1u);
  return lines.at(0);
}

TEST(Colors, AreTheModelsWhereTheyWereSeenOnIt) {
  const ColorHistograms colors = learned();
  cv::Mat3b picture(1, 3);
  picture(0, 0) = kOn;
  picture(0, 1) = kBeside;
  picture(0, 2) = {0, 255, 0};  // never seen
  const cv::Mat1f odds = colors.log_odds(picture, cv::Mat1b(1, 3, uchar{1}));
  EXPECT_GT(odds(0, 0), 5);
  EXPECT_LT(odds(0, 1), -5);
  EXPECT_EQ(odds(0, 2), 0);
  EXPECT_EQ(cv::countNonZero(colors.log_odds(picture, cv::Mat1b(1, 3, uchar{0}))), 0);
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
  cv::Mat3b picture(1, 1, kOn);
  const cv::Mat1b valid(1, 1, uchar{1});
  const float odds = colors.log_odds(picture, valid)(0, 0);
  EXPECT_NEAR(odds, std::log(0.8 / 0.2), 0.05);
  colors.count(kBeside, true);
  colors.discard();
  colors.learn(0.5);
  EXPECT_EQ(colors.log_odds(picture, valid)(0, 0), odds);
}

TEST(LineDistribution, FindsTheStepWhereItIs) {
  float before = -6;
  for (int step = -4; step <= 4; ++step) {
    const auto edge = static_cast<float>(step) + 0.5f;
    Segments likeness;
    for (int k = 0; k < kSegments; ++k)
      likeness[static_cast<std::size_t>(k)] = from_middle(k) < edge ? 0.95f : -0.95f;
    const Place place = find_place(likeness);
    if (std::abs(step) < 3) {  // cut off at the line's ends
      EXPECT_NEAR(place.mean, edge, 0.2);
    }
    EXPECT_GT(place.mean, before + 0.5f);
    EXPECT_LT(place.variance, 4);
    before = place.mean;
  }
}

TEST(LineDistribution, IsWideWhereColorsSayNothing) {
  const Place place = find_place(Segments{});
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
  const cv::Vec3b on(100, 100, 100), beside(118, 100, 100);
  const cv::Mat4f picture = with_alpha(edge_at(32, on, beside));
  const Place place{1.5f, 0.7f};
  const Place kept = refine_place(place, picture, {30, 30}, {1, 0});
  EXPECT_EQ(kept.mean, place.mean);
  EXPECT_EQ(kept.variance, place.variance);
}

TEST(Line, IsLessSureWhereBothWaysDisagree) {
  const cv::Mat4f picture = with_alpha(edge_at(30));
  const Place near = refine_place({0, 0.5f}, picture, {30, 30}, {1, 0});
  const Place far = refine_place({1.4f, 0.5f}, picture, {30, 30}, {1, 0});
  EXPECT_GT(far.variance, near.variance + 2);
}

TEST(Line, AcrossAThinPartIsLeftOut) {
  const TileCamera camera{60, 60, 100, 100, 0, 0, Eigen::Isometry3d::Identity()};
  const RegionView view{&camera, with_alpha(edge_at(30)), cv::Mat1f(60, 60, 1.0f)};
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
