#include "shape/frame_sample.hpp"

#include <gtest/gtest.h>

namespace hypotrack {
namespace {

std::vector<int> sampled(int wanted, int frames, int lost_below = 0) {
  FrameSample sample(wanted);
  for (int i = 0; i < frames; ++i) {
    Solution solution;
    solution.status = i < lost_below ? Status::lost : Status::tracked;
    Frame frame;
    frame.index = i;
    sample.add(frame, solution);
  }
  std::vector<int> indices;
  for (const TrackedFrame& f : sample.take()) indices.push_back(f.frame.index);
  return indices;
}

TEST(FrameSample, SpreadsOverHoweverManyFramesThereAre) {
  for (const int frames : {8, 13, 31, 100, 1000}) {
    const std::vector<int> indices = sampled(8, frames);
    ASSERT_EQ(indices.size(), 8u) << frames;
    EXPECT_EQ(indices.front(), 0);
    EXPECT_GE(indices.back(), frames * 3 / 4 - 1) << frames;
    for (std::size_t i = 1; i < indices.size(); ++i) {
      EXPECT_GT(indices[i], indices[i - 1]);
      EXPECT_LE(indices[i] - indices[i - 1], 4 * frames / 8) << frames;
    }
  }
}

TEST(FrameSample, TakesAllWhereThereAreFew) { EXPECT_EQ(sampled(8, 3), (std::vector{0, 1, 2})); }

TEST(FrameSample, TakesOnlyWhatWasTracked) { EXPECT_EQ(sampled(4, 6, 3), (std::vector{3, 4, 5})); }

}  // namespace
}  // namespace hypotrack
