#include "tile/grid_lookup.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "every_target.hpp"
#include "scene/simd_kernels.hpp"

namespace hypotrack {
namespace {

cv::Mat3b random_picture(int width, int height) {
  cv::Mat3b out(height, width);
  cv::RNG random(7);
  random.fill(out, cv::RNG::UNIFORM, 0, 256);
  return out;
}

/// Returns positions from `first` on, `step` apart.
std::vector<float> positions(int count, float first, float step) {
  std::vector<float> out;
  for (int i = 0; i < count; ++i) out.push_back(first + step * static_cast<float>(i));
  return out;
}

/// Looks a picture up as OpenCV does.
cv::Mat3b reference(const cv::Mat3b& picture, const std::vector<float>& columns,
                    const std::vector<float>& rows, int samples) {
  const cv::Mat1f x =
      cv::repeat(cv::Mat1f(columns).reshape(1, 1), static_cast<int>(rows.size()), 1);
  const cv::Mat1f y = cv::repeat(cv::Mat1f(rows), 1, static_cast<int>(columns.size()));
  cv::Mat3b out;
  cv::remap(picture, out, x, y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  if (samples > 1) cv::resize(out, out, out.size() / samples, 0, 0, cv::INTER_AREA);
  return out;
}

void expect_equal(int size, int samples, float first, float step) {
  SCOPED_TRACE(testing::Message() << size << " " << samples << " " << first << " " << step);
  const cv::Mat3b picture = random_picture(90, 70);
  const std::vector<float> columns = positions(size * samples, first, step);
  const std::vector<float> rows = positions(size * samples, first + 0.3f, 0.9f * step);
  const cv::Mat3b found = look_up_grid(picture, axis_places(columns, picture.cols),
                                       axis_places(rows, picture.rows), samples);
  EXPECT_EQ(cv::norm(found, reference(picture, columns, rows, samples), cv::NORM_INF), 0);
}

TEST(GridLookup, EqualsOpenCvsBitByBitOnEveryInstructionSet) {
  test::on_every_target(compiled_simd_targets(), [] {
    for (const int samples : {1, 2})
      for (const int size : {32, 37, 1})
        for (const float step : {0.21f, 0.78f, 1.15f}) expect_equal(size, samples, 4.123f, step);
  });
}

TEST(GridLookup, RepeatsTheBorder) {
  for (const int samples : {1, 2}) expect_equal(40, samples, -7.3f, 1.1f);
  expect_equal(64, 2, 60.5f, 1.0f);
  expect_equal(20, 1, 300, 1.0f);
}

TEST(GridLookup, SkipsRowsWhereTheyAreFarApart) {
  expect_equal(16, 1, 2.4f, 4.7f);
  expect_equal(8, 2, 2.4f, 5.1f);
}

}  // namespace
}  // namespace hypotrack
