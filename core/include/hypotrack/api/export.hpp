#pragma once

#if __cplusplus < 202002L
#include "hypotrack needs C++20: compile with -std=c++20 (CMake: set CMAKE_CXX_STANDARD to 20)"
#endif

/// Marks a public name: visible outside its library, also where code is compiled with hidden
/// visibility.
#define HYPOTRACK_API __attribute__((visibility("default")))
