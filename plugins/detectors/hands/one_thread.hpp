#pragma once

#include <omp.h>

namespace hypotrack::hands {

/// Keeps oneDNN, whose threads are those of OpenMP, to the calling thread.
class OneThread {
 public:
  OneThread() : before_(omp_get_max_threads()) { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_;
};

}  // namespace hypotrack::hands
