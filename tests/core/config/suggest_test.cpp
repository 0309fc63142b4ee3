#include <gtest/gtest.h>

#include "hypotrack/api/text.hpp"

namespace hypotrack {
namespace {

TEST(Suggest, OneEditIsForgivenInShortWords) {
  const std::vector<std::string> words = {"seed"};
  for (const char* word : {"sxeed", "sed", "sead", "esed"})  // the last: neighbours swapped
    EXPECT_EQ(did_you_mean(word, words), "; did you mean 'seed'?") << word;
  for (const char* word : {"xsxed", "sd", "saad", "edse"})
    EXPECT_EQ(did_you_mean(word, words), "") << word;
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
}  // namespace hypotrack
