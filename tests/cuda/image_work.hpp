#pragma once

#include <opencv2/core/mat.hpp>

namespace hypotrack::test {

/// Makes, clones, resizes, cuts and frees images of many sizes on several threads. The number of
/// images whose content was not what was written.
int damaged_images(int threads, int rounds);

}  // namespace hypotrack::test
