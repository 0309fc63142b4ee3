// Compiled once for every instruction set: the include below includes this file again.

#define HWY_TARGET_INCLUDE "scene/skin_kernel.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "scene/block_vectors-inl.hpp"
#include "scene/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {
namespace {

void skin(const SkinBlocks& blocks, const float* bones, float* out_x, float* out_y, float* out_z) {
  const std::size_t count = blocks.first_entry.size() - 1;
  const Vec unit = hn::Set(f, blocks.weight_unit);
  for (std::size_t block = 0; block < count; ++block) {
    for (std::size_t lane = 0; lane < kBlock; lane += kLanes) {
      const float* position = blocks.aligned_positions + block * 3 * kBlock + lane;
      const Vec at_x = hn::Load(f, position), at_y = hn::Load(f, position + kBlock);
      const Vec at_z = hn::Load(f, position + 2 * kBlock);
      Vec x = hn::Zero(f), y = hn::Zero(f), z = hn::Zero(f);
      for (auto e = blocks.first_entry[block]; e < blocks.first_entry[block + 1]; ++e) {
        const float* bone = bones + std::size_t{blocks.bone[e]} * 12;
        const Vec w = hn::Load(f, blocks.aligned_weights + std::size_t{e} * kBlock + lane);
        x = hn::MulAdd(w, transform_fused(bone, at_x, at_y, at_z), x);
        y = hn::MulAdd(w, transform_fused(bone + 4, at_x, at_y, at_z), y);
        z = hn::MulAdd(w, transform_fused(bone + 8, at_x, at_y, at_z), z);
      }
      const std::size_t at = block * kBlock + lane;
      hn::Store(hn::Mul(x, unit), f, out_x + at);
      hn::Store(hn::Mul(y, unit), f, out_y + at);
      hn::Store(hn::Mul(z, unit), f, out_z + at);
    }
  }
}

const char* target_name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace hypotrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::internal {
namespace {
HWY_EXPORT(skin);
HWY_EXPORT(target_name);
}  // namespace

void skin_blocks(const SkinBlocks& blocks, const float* bones, float* x, float* y, float* z) {
  HWY_DYNAMIC_DISPATCH(skin)(blocks, bones, x, y, z);
}

std::int64_t compiled_simd_targets() { return HWY_TARGETS; }

const char* simd_target() { return HWY_DYNAMIC_DISPATCH(target_name)(); }

}  // namespace hypotrack::internal
#endif
