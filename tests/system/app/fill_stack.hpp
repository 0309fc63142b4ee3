#pragma once

/// Calls itself until the stack is full.
inline int fill_stack(int depth) {  // NOLINT(misc-no-recursion)
  volatile char piece[4096];
  piece[0] = static_cast<char>(depth);
  return depth < 0 ? 0 : fill_stack((depth + 1) % 1000) + piece[0];
}
