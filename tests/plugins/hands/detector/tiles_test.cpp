#include <gmock/gmock.h>

#include "region.hpp"

namespace hypotrack::hands {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Tiles, GetSmallerDownToTheSmallestHand) {
  EXPECT_THAT(tile_sides({1280, 720}, 50), ElementsAre(640, 320));
  EXPECT_THAT(tile_sides({640, 480}, 50), ElementsAre(320));
  EXPECT_THAT(tile_sides({720, 720}, 50), ElementsAre(320)) << "which finds all that 360 would";
  EXPECT_THAT(tile_sides({640, 480}, 0), IsEmpty());
  EXPECT_THAT(tile_sides({640, 480}, 120), IsEmpty());
  EXPECT_THAT(tile_sides({128, 128}, 1), ElementsAre(64)) << "there is no end otherwise";
}

TEST(Tiles, CoverThePictureAndOverlapByHalf) {
  for (const cv::Size size : {cv::Size(1280, 720), cv::Size(641, 999), cv::Size(320, 320),
                              cv::Size(200, 1000), cv::Size(321, 100)}) {
    const std::vector<cv::Rect> all = tiles(size, 320);
    const cv::Rect whole({}, size);
    // A hand of half a tile lies within some tile, wherever it is.
    for (int y = 0; y < size.height; y += 7) {
      for (int x = 0; x < size.width; x += 7) {
        const cv::Rect hand = cv::Rect(x, y, 160, 160) & whole;
        EXPECT_TRUE(std::any_of(
            all.begin(), all.end(),
            [&](const cv::Rect& tile) { return (tile & whole) == tile && (tile & hand) == hand; }))
            << size << hand;
      }
    }
  }
}

}  // namespace
}  // namespace hypotrack::hands
