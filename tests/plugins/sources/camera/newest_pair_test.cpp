#include "newest_pair.hpp"

#include <gmock/gmock.h>

namespace hypotrack::live {
namespace {

std::deque<Picture> taken_at(const std::vector<std::int64_t>& stamps) {
  std::deque<Picture> pictures;
  for (const std::int64_t stamp : stamps) pictures.push_back({.image = {}, .stamp = stamp});
  return pictures;
}

/// Stamps of the pair; nothing if there is none.
std::vector<std::int64_t> pair_of(const std::vector<std::int64_t>& first,
                                  const std::vector<std::int64_t>& second, std::int64_t tolerance) {
  const auto pair = newest_pair(taken_at(first), taken_at(second), tolerance);
  if (!pair) return {};
  return {first[pair->first], second[pair->second]};
}

using testing::ElementsAre;
using testing::IsEmpty;

TEST(NewestPair, TakesTheNewestPictureThatHasAPartner) {
  EXPECT_THAT(pair_of({100, 200, 300}, {110, 210, 310}, 20), ElementsAre(300, 310));
  EXPECT_THAT(pair_of({100, 200, 300}, {110, 210}, 20), ElementsAre(200, 210));
  EXPECT_THAT(pair_of({100}, {110, 210, 310}, 20), ElementsAre(100, 110));
}

TEST(NewestPair, TakesTheNearestPartnerOnEitherSide) {
  EXPECT_THAT(pair_of({200}, {150, 190, 215, 300}, 60), ElementsAre(200, 190));
  EXPECT_THAT(pair_of({200}, {150, 185, 210, 300}, 60), ElementsAre(200, 210));
}

TEST(NewestPair, ToleratesExactlyTheTolerance) {
  EXPECT_THAT(pair_of({100}, {120}, 20), ElementsAre(100, 120));
  EXPECT_THAT(pair_of({100}, {121}, 20), IsEmpty());
  EXPECT_THAT(pair_of({100}, {100}, 0), ElementsAre(100, 100));
}

TEST(NewestPair, FindsNothingInAnEmptyQueue) {
  EXPECT_THAT(pair_of({}, {100}, 50), IsEmpty());
  EXPECT_THAT(pair_of({100}, {}, 50), IsEmpty());
}

}  // namespace
}  // namespace hypotrack::live
