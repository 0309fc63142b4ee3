#include "track/recover/empty_places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "camera_pair.hpp"

namespace hypotrack {
namespace {

constexpr double kNearEachOther = 0.06;
const Eigen::Vector3d kHere(0, 0, 0.5), kThere(0.12, 0, 0.5);

Frame gray(int level) {
  Frame frame;
  for (const Camera& camera : test::camera_pair(kNearEachOther))
    frame.views.push_back(
        {.color = cv::Mat(camera.height, camera.width, CV_8UC3, cv::Scalar::all(level))});
  return frame;
}

/// Whether each of some frames makes a search worth while.
std::vector<bool> worth(EmptyPlaces& places, int frames, int level, Eigen::Vector3d at) {
  std::vector<bool> out;
  for (int i = 0; i < frames; ++i) {
    out.push_back(places.is_worth(gray(level), at));
    places.end_frame();
  }
  return out;
}

TEST(EmptyPlaces, APlaceThatStaysAsItIsIsSearchedTwice) {
  EmptyPlaces places(test::camera_pair(kNearEachOther), 0.05);
  EXPECT_EQ(worth(places, 4, 100, kHere), (std::vector<bool>{true, true, false, false}));
}

TEST(EmptyPlaces, APlaceThatChangesIsSearchedAnew) {
  EmptyPlaces places(test::camera_pair(kNearEachOther), 0.05);
  worth(places, 4, 100, kHere);
  EXPECT_TRUE(places.is_worth(gray(130), kHere));
}

TEST(EmptyPlaces, NoiseIsNoChange) {
  EmptyPlaces places(test::camera_pair(kNearEachOther), 0.05);
  worth(places, 4, 100, kHere);
  EXPECT_FALSE(places.is_worth(gray(102), kHere));
}

TEST(EmptyPlaces, OtherPlacesHaveSearchesOfTheirOwn) {
  EmptyPlaces places(test::camera_pair(kNearEachOther), 0.05);
  for (int i = 0; i < 3; ++i) places.is_worth(gray(100), kHere);
  EXPECT_TRUE(places.is_worth(gray(100), kThere));
  EXPECT_FALSE(places.is_worth(gray(100), kHere + Eigen::Vector3d(0.01, 0, 0))) << "it wobbles";
}

TEST(EmptyPlaces, IsSearchedOnceMoreNowAndThen) {
  EmptyPlaces places(test::camera_pair(kNearEachOther), 0.05);
  const std::vector<bool> all = worth(places, 20, 100, kHere);
  EXPECT_EQ(std::count(all.begin(), all.end(), true), 4);
}

TEST(EmptyPlaces, ForgetsWhatIsNotAskedFor) {
  EmptyPlaces places(test::camera_pair(kNearEachOther), 0.05);
  worth(places, 4, 100, kHere);
  worth(places, 1, 100, kThere);
  EXPECT_TRUE(places.is_worth(gray(100), kHere));
}

}  // namespace
}  // namespace hypotrack
