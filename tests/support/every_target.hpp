#pragma once

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cstdint>
#include <type_traits>

namespace hypotrack::test {

/// Returns whether an instruction set (Highway's bit) has a fused multiply-add.
constexpr bool fuses_products_and_sums(std::int64_t target) {
#if HWY_ARCH_X86
  return target <= HWY_AVX2;  // smaller ones are better
#else
  return target != HWY_SCALAR && target != HWY_EMU128;
#endif
}
/// Returns whether the best instruction set of this machine has a fused multiply-add.
inline bool fuses_products_and_sums() {
  const std::int64_t targets = hwy::SupportedTargets();
  return fuses_products_and_sums(targets & -targets);
}

/// Runs a body once per instruction set (Highway's bit) that this machine has and `compiled`
/// contains. The body may take the bit as its argument. Users must link Highway.
template <class Body>
void on_every_target(std::int64_t compiled, Body body) {
  int targets = 0;
  for (std::int64_t rest = hwy::SupportedTargets() & compiled; rest != 0; rest &= rest - 1) {
    const std::int64_t target = rest & -rest;
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    if constexpr (std::is_invocable_v<Body, std::int64_t>) {
      body(target);
    } else {
      body();
    }
    ++targets;
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  EXPECT_GE(targets, 1);
}

}  // namespace hypotrack::test
