#pragma once

#include <omp.h>

namespace hypotrack::hands {

/// Gives oneDNN, whose threads are those of OpenMP, a number of threads, the
/// calling one included.
class OmpThreads {
 public:
  explicit OmpThreads(int threads) : before_(omp_get_max_threads()), several_(threads > 1) {
    omp_set_num_threads(threads);
  }
  ~OmpThreads() {
    // They would keep cores busy while they wait for more work of this thread.
    if (several_) omp_pause_resource(omp_pause_soft, omp_get_initial_device());
    omp_set_num_threads(before_);
  }
  OmpThreads(const OmpThreads&) = delete;
  OmpThreads& operator=(const OmpThreads&) = delete;

 private:
  int before_;
  bool several_;
};

}  // namespace hypotrack::hands
