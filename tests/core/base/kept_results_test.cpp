#include "base/kept_results.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace hypotrack::internal {
namespace {

/// Texts that weigh as much as they are long, and how many were made.
struct KeptTexts {
  KeptResults<int, std::string> kept{[](const std::string& text) { return text.size(); }};
  std::atomic<int> made = 0;

  std::string get(int key, const std::string& text) {
    return kept.get(key, [&] {
      ++made;
      return text;
    });
  }
};

TEST(KeptResults, AreMadeOnce) {
  KeptTexts texts;
  texts.kept.keep(100);
  EXPECT_EQ(texts.get(1, "one"), "one");
  EXPECT_EQ(texts.get(1, "another"), "one");
  EXPECT_EQ(texts.made, 1);
}

TEST(KeptResults, AreNotMoreThanTheWeightAndTheOnesWantedLast) {
  KeptTexts texts;
  texts.kept.keep(10);
  for (const int key : {1, 2, 1, 3}) texts.get(key, "1234");  // 2 is the one wanted least recently
  EXPECT_EQ(texts.made, 3);
  texts.get(1, "1234");
  EXPECT_EQ(texts.made, 3);
  texts.get(2, "1234");
  EXPECT_EQ(texts.made, 4);
}

TEST(KeptResults, HeavierThanAllAndWithoutWeightAreNotKept) {
  KeptTexts texts;
  texts.kept.keep(3);
  for (int i = 0; i < 2; ++i) {
    texts.get(1, "heavy");
    texts.get(2, "");
  }
  EXPECT_EQ(texts.made, 4);
}

TEST(KeptResults, ThatFailedAreMadeAgain) {
  KeptTexts texts;
  texts.kept.keep(10);
  const auto fail = []() -> std::string { throw std::runtime_error("no"); };
  EXPECT_THROW(texts.kept.get(1, fail), std::runtime_error);
  EXPECT_EQ(texts.get(1, "one"), "one");
}

TEST(KeptResults, AreMadeByOneThreadWhileOthersWait) {
  KeptTexts texts;
  texts.kept.keep(10);
  std::vector<std::jthread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&] {
      const std::string text = texts.kept.get(1, [&] {
        ++texts.made;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return std::string("slow");
      });
      EXPECT_EQ(text, "slow");
    });
  }
  threads.clear();
  EXPECT_EQ(texts.made, 1);
}

}  // namespace
}  // namespace hypotrack::internal
