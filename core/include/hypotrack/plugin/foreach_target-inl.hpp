// Included once per instruction set: no #pragma once.

/// Includes Highway in a source that is compiled once per instruction set, and selects the same
/// instruction sets in all of hypotrack. simd-inl.hpp shows such a source. Use angle brackets:
/// clang-format then sorts this include before all headers that include Highway.
///
///   #define HWY_TARGET_INCLUDE "my_term.cpp"  // is included again for every instruction set
///   #include <hypotrack/plugin/foreach_target-inl.hpp>
///
/// Scalable vectors are disabled because structs cannot hold them. SSSE3 and AVX3_DL are disabled
/// because they gain too little over SSE4 and AVX3.
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)

#include <hwy/foreach_target.h>
// foreach_target.h comes first:
#include <hwy/highway.h>
