// For builds with ThreadSanitizer: Debian's OpenCV ends its tasks in code that is not instrumented.

#include <opencv2/core/utility.hpp>

namespace {

[[gnu::constructor]] void keep_opencv_in_one_thread() { cv::setNumThreads(1); }

}  // namespace
