#include "base/profile.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace hypotrack {
namespace {

void work(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

void frame() {
  const ProfiledPart whole("frame");
  for (int k = 0; k < 2; ++k) {
    const ProfiledPart part("search");
    work(2);
  }
  const ProfiledPart part("judge");
  work(1);
}

TEST(Profile, NestsPartsAsTheirScopesAre) {
  Profile profile;
  const ProfileScope scope(profile);
  frame();
  frame();
  const std::vector<Profile::Part>& parts = profile.parts();
  ASSERT_EQ(parts.size(), 4u);
  EXPECT_EQ(parts[1].name, "frame");
  EXPECT_EQ(parts[1].parent, 0u);
  EXPECT_EQ(parts[1].calls, 2);
  EXPECT_EQ(parts[2].name, "search");
  EXPECT_EQ(parts[2].parent, 1u);
  EXPECT_EQ(parts[2].calls, 4);
  EXPECT_EQ(parts[3].name, "judge");
  EXPECT_EQ(parts[3].parent, 1u);
  EXPECT_GE(parts[2].seconds, 0.008);
  EXPECT_GE(parts[1].seconds, parts[2].seconds + parts[3].seconds);
}

TEST(Profile, WaitsAtTheEndOfEveryScope) {
  int waits = 0;
  Profile profile([&] {
    ++waits;
    work(1);
  });
  const ProfileScope scope(profile);
  frame();
  EXPECT_EQ(waits, 4);
  EXPECT_GE(profile.parts()[2].waited_seconds, 0.002);
  EXPECT_GE(profile.parts()[2].seconds, 0.006);
}

TEST(Profile, OfAnotherThreadCountsNothingHere) {
  Profile profile;
  const ProfileScope scope(profile);
  std::thread(frame).join();
  EXPECT_EQ(profile.parts().size(), 1u);
}

TEST(Profile, EndsWithItsScope) {
  Profile profile;
  { const ProfileScope scope(profile); }
  frame();
  EXPECT_EQ(profile.parts().size(), 1u);
}

}  // namespace
}  // namespace hypotrack
