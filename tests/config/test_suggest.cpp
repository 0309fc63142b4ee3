#include <gtest/gtest.h>

#include "base/suggest.hpp"

namespace hypotrack::detail {
namespace {

TEST(Suggest, DistanceCountsSingleEdits) {
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("particles", "particles"), 0);
  EXPECT_EQ(edit_distance("partikles", "particles"), 1);
  EXPECT_EQ(edit_distance("aprticles", "particles"), 1) << "neighbours swapped";
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(Suggest, NamesTheNearestCandidate) {
  const std::vector<std::string> words = {"generations", "particles", "seed"};
  EXPECT_EQ(did_you_mean("partikles", words), "; did you mean 'particles'?");
  EXPECT_EQ(did_you_mean("sede", words), "; did you mean 'seed'?");
  EXPECT_EQ(did_you_mean("gener", words), "; did you mean 'generations'?");
}

TEST(Suggest, IsSilentWhereNothingIsNear) {
  const std::vector<std::string> words = {"generations", "particles", "c1"};
  EXPECT_EQ(did_you_mean("texture", words), "");
  EXPECT_EQ(did_you_mean("", words), "");
  EXPECT_EQ(did_you_mean("x", {}), "");
  EXPECT_EQ(did_you_mean(std::string(100000, 'a'), words), "");
}

}  // namespace
}  // namespace hypotrack::detail
