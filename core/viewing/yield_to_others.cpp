#include "viewing/yield_to_others.hpp"

#include <sys/resource.h>
#include <unistd.h>

namespace hypotrack {

void yield_to_others() {
  constexpr int kNice = 10;
  // Linux has a nice value per thread, set by the thread's id in place of a process's.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
}

}  // namespace hypotrack
