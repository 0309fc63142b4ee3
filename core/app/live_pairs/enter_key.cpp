#include "live_pairs/enter_key.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>

namespace hypotrack::app {

bool EnterKey::pressed() {
  if (isatty(STDIN_FILENO) == 1 && tcgetpgrp(STDIN_FILENO) != getpgrp()) return false;
  for (pollfd input{STDIN_FILENO, POLLIN, 0}; !ended_ && poll(&input, 1, 0) > 0;) {
    std::array<char, 256> text{};
    const ssize_t size = read(STDIN_FILENO, text.data(), text.size());
    ended_ = size <= 0;
    if (std::ranges::count(text, '\n') > 0) return true;
  }
  return false;
}

}  // namespace hypotrack::app
