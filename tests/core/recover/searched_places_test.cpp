#include "track/recover/searched_places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace hypotrack {
namespace {

const Eigen::Vector3d kHere(0, 0, 0.5), kThere(0.12, 0, 0.5);

std::vector<Camera> pair() {
  Camera camera{640, 480, 500, 500, 319.5, 239.5, DistortionModel::none, {}, {}};
  camera.camera_from_world = Eigen::Isometry3d::Identity();
  std::vector<Camera> cameras(2, camera);
  cameras[1].camera_from_world.translation().x() = -0.06;
  return cameras;
}

Frame gray(int level) {
  Frame frame;
  for (const Camera& camera : pair())
    frame.views.push_back(
        {.color = cv::Mat(camera.height, camera.width, CV_8UC3, cv::Scalar::all(level))});
  return frame;
}

/// Whether each of some frames makes a search worth while.
std::vector<bool> worth(SearchedPlaces& places, int frames, int level, Eigen::Vector3d at) {
  std::vector<bool> out;
  for (int i = 0; i < frames; ++i) {
    out.push_back(places.is_worth(gray(level), at));
    places.end_frame();
  }
  return out;
}

TEST(SearchedPlaces, APlaceThatStaysAsItIsIsSearchedTwice) {
  SearchedPlaces places(pair(), 0.05);
  EXPECT_EQ(worth(places, 4, 100, kHere), (std::vector<bool>{true, true, false, false}));
}

TEST(SearchedPlaces, APlaceThatChangesIsSearchedAnew) {
  SearchedPlaces places(pair(), 0.05);
  worth(places, 4, 100, kHere);
  EXPECT_TRUE(places.is_worth(gray(130), kHere));
}

TEST(SearchedPlaces, NoiseIsNoChange) {
  SearchedPlaces places(pair(), 0.05);
  worth(places, 4, 100, kHere);
  EXPECT_FALSE(places.is_worth(gray(102), kHere));
}

TEST(SearchedPlaces, OtherPlacesHaveSearchesOfTheirOwn) {
  SearchedPlaces places(pair(), 0.05);
  for (int i = 0; i < 3; ++i) places.is_worth(gray(100), kHere);
  EXPECT_TRUE(places.is_worth(gray(100), kThere));
  EXPECT_FALSE(places.is_worth(gray(100), kHere + Eigen::Vector3d(0.01, 0, 0))) << "it wobbles";
}

TEST(SearchedPlaces, IsSearchedOnceMoreNowAndThen) {
  SearchedPlaces places(pair(), 0.05);
  const std::vector<bool> all = worth(places, 20, 100, kHere);
  EXPECT_EQ(std::count(all.begin(), all.end(), true), 4);
}

TEST(SearchedPlaces, ForgetsWhatIsNotAskedFor) {
  SearchedPlaces places(pair(), 0.05);
  worth(places, 4, 100, kHere);
  worth(places, 1, 100, kThere);
  EXPECT_TRUE(places.is_worth(gray(100), kHere));
}

}  // namespace
}  // namespace hypotrack
