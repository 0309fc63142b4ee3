#pragma once

#include "hand_detection.hpp"

namespace hypotrack::test {

/// Returns a flat hand whose fingers are vertical: wrist at the bottom.
inline HandPoints upright_hand() {
  HandPoints out;
  out.col(0) << 0, 100;
  for (int finger = 0; finger < 5; ++finger)
    for (int joint = 0; joint < 4; ++joint)
      out.col(1 + 4 * finger + joint) << 20.0 * (finger - 2), 20 - 25.0 * joint;
  return out;
}

}  // namespace hypotrack::test
