#pragma once

namespace hypotrack::app {

/// Tells whether the user pressed Enter, without waiting. A program in the background never reads.
class EnterKey {
 public:
  bool pressed();

 private:
  bool ended_ = false;  ///< standard input
};

}  // namespace hypotrack::app
