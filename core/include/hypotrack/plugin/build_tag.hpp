#pragma once

#include <Eigen/Core>
#include <opencv2/core/version.hpp>

// The build tag names all that core and a plugin must share before C++ objects may cross: C++
// standard, compiler ABI, string ABI, Eigen and its alignment, OpenCV, containers (_GLIBCXX_DEBUG)
// and sanitizer.
#define HYPOTRACK_TAG_(x) #x
#define HYPOTRACK_TAG(x) HYPOTRACK_TAG_(x)

#if defined(__SANITIZE_ADDRESS__)
#define HYPOTRACK_TAG_SANITIZER "asan"
#elif defined(__SANITIZE_THREAD__)
#define HYPOTRACK_TAG_SANITIZER "tsan"
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define HYPOTRACK_TAG_SANITIZER "asan"
#elif __has_feature(thread_sanitizer)
#define HYPOTRACK_TAG_SANITIZER "tsan"
#endif
#endif
#ifndef HYPOTRACK_TAG_SANITIZER
#define HYPOTRACK_TAG_SANITIZER "none"
#endif

#ifdef _GLIBCXX_DEBUG
#define HYPOTRACK_TAG_CONTAINERS "checked"
#else
#define HYPOTRACK_TAG_CONTAINERS "plain"
#endif

namespace hypotrack {

// clang-format off
inline constexpr const char* kBuildTag =
    "c++ " HYPOTRACK_TAG(__cplusplus)
    ", cxxabi " HYPOTRACK_TAG(__GXX_ABI_VERSION)
    ", cxx11-strings " HYPOTRACK_TAG(_GLIBCXX_USE_CXX11_ABI)
    ", eigen " HYPOTRACK_TAG(EIGEN_WORLD_VERSION) "." HYPOTRACK_TAG(EIGEN_MAJOR_VERSION) "."
    HYPOTRACK_TAG(EIGEN_MINOR_VERSION)
    ", eigen-align " HYPOTRACK_TAG(EIGEN_MAX_ALIGN_BYTES)
    ", opencv " CV_VERSION
    ", containers " HYPOTRACK_TAG_CONTAINERS
    ", sanitizer " HYPOTRACK_TAG_SANITIZER;
// clang-format on

}  // namespace hypotrack
