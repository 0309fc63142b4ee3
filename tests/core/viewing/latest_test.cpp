#include "viewing/latest.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace hypotrack {
namespace {

constexpr std::chrono::milliseconds kLong{60000};

TEST(Latest, ALateReaderGetsTheNewestValueOnly) {
  Latest<int> latest;
  EXPECT_EQ(latest.get().number, 0);
  for (const int value : {10, 20, 30}) latest.put(value);
  const auto entry = latest.wait_after(1, kLong);
  EXPECT_EQ(entry.number, 3);
  EXPECT_EQ(*entry.value, 30);
}

TEST(Latest, WaitsForANewValue) {
  Latest<int> latest;
  latest.put(1);
  std::thread writer([&] { latest.put(2); });
  EXPECT_EQ(*latest.wait_after(1, kLong).value, 2);
  writer.join();
}

TEST(Latest, ClosingEndsTheWaiting) {
  Latest<int> latest;
  latest.put(1);
  std::thread closer([&] { latest.close(); });
  EXPECT_EQ(latest.wait_after(1, kLong).number, 1);
  closer.join();
  EXPECT_TRUE(latest.closed());
}

}  // namespace
}  // namespace hypotrack
