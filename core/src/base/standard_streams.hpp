#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <initializer_list>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Opens /dev/null in place of standard input, output and error where one is closed. The next files
/// to be opened would get their descriptors, and what is printed would land in them. The first call
/// in main() of every program. Ends the program if /dev/null cannot be opened.
inline void open_standard_streams() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(number, F_GETFD) >= 0 || errno != EBADF) continue;
    // Gets this number, which is the lowest free one: those below are open.
    const int opened = open("/dev/null", number == STDIN_FILENO ? O_RDONLY : O_WRONLY);
    if (opened != number) std::_Exit(EXIT_FAILURE);  // there may be nowhere to say why
  }
}

}  // namespace internal
}  // namespace hypotrack
