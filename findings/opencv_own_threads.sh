#!/usr/bin/env bash
# OpenCV with TBB runs its parallel loops in an arena of its own. A program that tracks several streams
# gives each a task_arena of few threads, yet cv::remap() or cv::resize() within it take threads on all
# cores. Only cv::setNumThreads() limits them, for the whole process.
set -euo pipefail

need() { # PACKAGE VERSION: Debian's package of this version, or exit 77
  local installed
  installed=$(dpkg-query -W -f '${Version}' "$1" 2>/dev/null || true)
  case $installed in
    "$2"*) echo "$1 $installed" ;;
    *) echo "missing: $1 $2" && exit 77 ;;
  esac
}
need g++ 4:12
need libopencv-dev 4.6.0
need libtbb-dev 2021.8
[ "$(nproc)" -ge 2 ] || { echo "missing: a second core"; exit 77; }

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/main.cpp" <<'END'
#include <cstdio>
#include <mutex>
#include <opencv2/core/utility.hpp>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <set>
#include <thread>

int main() {
  std::mutex mutex;
  std::set<std::thread::id> threads;
  const auto work = [&](int) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const std::lock_guard<std::mutex> lock(mutex);
    threads.insert(std::this_thread::get_id());
  };
  const auto count = [&](const auto& loop) {
    threads.clear();
    tbb::task_arena(1).execute(loop);
    return threads.size();
  };
  const auto own = count([&] { tbb::parallel_for(0, 32, work); });
  const auto by_opencv = count([&] {
    cv::parallel_for_({0, 32}, [&](const cv::Range& part) {
      for (int i = part.start; i < part.end; ++i) work(i);
    }, 32);
  });
  cv::setNumThreads(1);
  const auto limited = count([&] {
    cv::parallel_for_({0, 32}, [&](const cv::Range& part) {
      for (int i = part.start; i < part.end; ++i) work(i);
    }, 32);
  });
  std::printf("expected: 1 thread in an arena of one thread, by TBB and by OpenCV\n");
  std::printf("seen:     %zu by TBB, %zu by OpenCV, %zu after cv::setNumThreads(1)\n", own,
              by_opencv, limited);
  return own == 1 && by_opencv > 1 && limited == 1 ? 0 : 1;
}
END
# shellcheck disable=SC2046  # several flags
g++ -std=c++17 -O1 -w "$folder/main.cpp" -o "$folder/main" $(pkg-config --cflags opencv4) -lopencv_core -ltbb
"$folder/main"
