#include "track/side_work.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "base/profile.hpp"
#include "base/stop_scope.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/stop.hpp"
#include "plugin/running_plugin.hpp"

namespace hypotrack {
namespace {

void sleep(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

/// Does something in an arena of so many threads.
template <class Function>
void in_arena(int threads, const Function& function) {
  tbb::task_arena arena(threads);
  arena.execute(function);
}

TEST(SideWork, IsDoneBesideItsOwner) {
  in_arena(2, [] {
    std::atomic<bool> goes_on = false;
    SideWork work("work");
    EXPECT_TRUE(work.has_thread());
    work.begin([&] {
      while (!goes_on) std::this_thread::yield();
    });
    goes_on = true;
    work.wait();
  });
}

TEST(SideWork, IsDoneAtOnceInAnArenaOfOneThread) {
  in_arena(1, [] {
    SideWork work("work");
    std::thread::id done_by;
    work.begin([&] { done_by = std::this_thread::get_id(); });
    EXPECT_EQ(done_by, std::this_thread::get_id());
    EXPECT_FALSE(work.has_thread());
    EXPECT_THROW(work.begin([] { throw std::runtime_error("no"); }), std::runtime_error);
    work.wait();
  });
}

TEST(SideWork, IsDoneBeforeTheNextOne) {
  in_arena(3, [] {
    constexpr int kTimes = 300;
    SideWork work("work");
    int done = 0;
    for (int i = 0; i < kTimes; ++i) {
      work.begin([&done] { ++done; });
      if (i % 3 == 0) work.wait();
    }
    work.wait();
    EXPECT_EQ(done, kTimes);
  });
}

TEST(SideWork, ThrowsOnceAndNamesTheFrameThatBeganIt) {
  in_arena(2, [] {
    SideWork work("learn looks");
    {
      const detail::RunningFrame frame(7);
      work.begin([] { throw DataError("there is no picture"); });
    }
    const detail::RunningFrame next(8);
    EXPECT_EQ(test::message_of<DataError>([&] { work.wait(); }),
              "learn looks of frame 7: there is no picture");
    work.wait();
    work.begin([] {});
    work.wait();
  });
}

TEST(SideWork, IsNotStoppedWithAFrameThatWaitsForIt) {
  in_arena(2, [] {
    const StopTest at_once = [] { return true; };
    const StopScope scope(at_once);
    EXPECT_THROW(check_stop(), Stopped);
    SideWork work("work");
    bool is_done = false;
    work.begin([&] {
      check_stop();
      is_done = true;
    });
    work.wait();
    EXPECT_TRUE(is_done);
  });
}

TEST(SideWork, EndsWithItsOwnerWhateverItThrows) {
  std::atomic<int> ended = 0;
  tbb::task_arena arena(2);
  {
    SideWork fails("work"), works("work");
    arena.execute([&] {
      for (SideWork* work : {&fails, &works})
        work->begin([&, work] {
          sleep(5);
          ++ended;
          if (work == &fails) throw std::runtime_error("nobody hears it");
        });
    });
  }  // outside of its arena
  EXPECT_EQ(ended, 2);
}

TEST(SideWork, CountsInProfilesBesideThem) {
  in_arena(2, [] {
    Profile profile;
    const ProfileScope scope(profile);
    SideWork work("work");
    std::atomic<bool> has_begun = false;
    work.begin([&] {
      has_begun = true;
      sleep(4);
    });
    while (!has_begun) std::this_thread::yield();  // else this thread may do it itself
    work.wait();
    ASSERT_EQ(profile.parts().size(), 2u);
    EXPECT_EQ(profile.parts()[1].name, "work");
    EXPECT_GE(profile.parts()[1].beside_seconds, 0.004);
  });
}

}  // namespace
}  // namespace hypotrack
