// Included once per instruction set: no #pragma once.

/// Highway, for a source that is compiled once for every instruction set: the same ones in all of
/// hypotrack. What such a source looks like is in simd-inl.hpp. Angle brackets keep this before
/// every other header of it that includes Highway, where clang-format sorts includes:
///
///   #define HWY_TARGET_INCLUDE "my_term.cpp"  // is included again for every instruction set
///   #include <hypotrack/foreach_target-inl.hpp>
///
/// Vectors of a length known only at run time do not fit structs that hold vectors; SSSE3 and
/// AVX3_DL are too near to SSE4 and AVX3 to be worth compiling.
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)

#include <hwy/foreach_target.h>
// After it:
#include <hwy/highway.h>
