#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "output/metrics/metrics.hpp"

namespace hypotrack {
namespace {

nlohmann::ordered_json json_of(double error_mm, bool lost) {
  MetricsCollector collector(landmark_layout(std::vector<std::string>{"ball.center"}));
  Eigen::Matrix3Xd estimate = Eigen::Matrix3Xd::Zero(3, 1);
  estimate(0, 0) = error_mm / 1000;
  collector.add(0, 0, {lost ? FrameStatus::lost : FrameStatus::solved}, estimate,
                Eigen::Matrix3Xd::Zero(3, 1));
  return nlohmann::ordered_json::parse(to_json(collector.metrics()));
}

TEST(MetricsJson, NumbersComeFirstAndNestedTablesLast) {
  std::vector<std::string> keys;
  const auto json = json_of(8.5, false);
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_THAT(
      keys, testing::ElementsAre(
                "frames", "evaluated_frames", "missing_frames", "mean_error_mm", "sd_error_mm",
                "median_error_mm", "p75_error_mm", "p90_error_mm", "p95_error_mm", "max_error_mm",
                "auc_20_50", "success_5mm", "success_10mm", "success_20mm", "success_30mm",
                "success_40mm", "success_50mm", "lost_frames", "lost_share", "time_to_loss_s",
                "frames_to_loss", "jitter_mm", "found_share", "search_failed_share",
                "objective_failed_share", "tracked_frames", "uncertain_frames", "said_lost_frames",
                "absent_frames", "tracked_share", "uncertain_share", "absent_share",
                "false_tracked_share", "right_tracked_share", "absent_tracked_share", "returns",
                "recovered_2_share", "recovered_10_share", "frames_to_recovery",
                "lost_sigma_min_mm", "models", "landmarks", "success_curve"));
}

TEST(MetricsJson, WhatIsUnknownIsNull) {
  const auto json = json_of(8.5, false);
  for (const char* key : {"tracked_frames", "tracked_share", "returns", "recovered_2_share"})
    EXPECT_TRUE(json.at(key).is_null()) << key << " of another tracker";
  EXPECT_EQ(json_of(8.5, true).at("said_lost_frames"), 1);
  EXPECT_TRUE(json.at("time_to_loss_s").is_null());
  EXPECT_TRUE(json.at("frames_to_loss").is_null());
  EXPECT_TRUE(json.at("jitter_mm").is_null());
  const auto lost = json_of(8.5, true);
  EXPECT_EQ(lost.at("frames_to_loss"), 0);
  EXPECT_EQ(lost.at("time_to_loss_s"), 0.0);
}

TEST(MetricsJson, TablesHaveTheirNamesAndTheCurveItsThresholds) {
  const auto json = json_of(8.5, false);
  EXPECT_NEAR(json.at("models").at("ball").get<double>(), 8.5, 1e-9);
  EXPECT_NEAR(json.at("landmarks").at("ball.center").get<double>(), 8.5, 1e-9);
  const auto& curve = json.at("success_curve");
  ASSERT_EQ(curve.at("threshold_mm").size(), 101U);
  ASSERT_EQ(curve.at("share").size(), 101U);
  EXPECT_EQ(curve.at("threshold_mm").back(), 100);
  EXPECT_EQ(curve.at("share")[8], 0.0);
  EXPECT_EQ(curve.at("share")[9], 1.0);
}

}  // namespace
}  // namespace hypotrack
