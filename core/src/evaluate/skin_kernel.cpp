// Compiled once per instruction set: the include below includes this file again.

#define HWY_TARGET_INCLUDE "evaluate/skin_kernel.cpp"
#include <hypotrack/foreach_target-inl.hpp>

#include "evaluate/block_vectors-inl.hpp"
#include "evaluate/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {
namespace {

// Returns a row of a 3x4 matrix times (x y z 1).
HWY_INLINE Vec transform(const float* row, Vec x, Vec y, Vec z) {
  const Vec sum = hn::MulAdd(hn::Set(f, row[2]), z, hn::Set(f, row[3]));
  return hn::MulAdd(hn::Set(f, row[0]), x, hn::MulAdd(hn::Set(f, row[1]), y, sum));
}

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
        x = hn::MulAdd(w, transform(bone, at_x, at_y, at_z), x);
        y = hn::MulAdd(w, transform(bone + 4, at_x, at_y, at_z), y);
        z = hn::MulAdd(w, transform(bone + 8, at_x, at_y, at_z), z);
      }
      const std::size_t at = block * kBlock + lane;
      hn::Store(hn::Mul(x, unit), f, out_x + at);
      hn::Store(hn::Mul(y, unit), f, out_y + at);
      hn::Store(hn::Mul(z, unit), f, out_z + at);
    }
  }
}

// A coordinate beyond all valid ones.
constexpr float kBeyond = 2 * kGuard;

HWY_INLINE Mask within_guard(Vec value) {
  return hn::Le(hn::Abs(value), hn::Set(f, kGuard));  // false for NaN
}

HWY_INLINE Mask within_depth(Vec z) {
  return hn::And(hn::Ge(z, hn::Set(f, kNear)), hn::Le(z, hn::Set(f, kFar)));
}

void project_one(const float* in_x, const float* in_y, const float* in_z, std::size_t count,
                 const ViewProjection& view, float* records, PixelRange& range) {
  const float* m = view.camera_from_first;
  const Vec one = hn::Set(f, 1.0f), zero = hn::Zero(f);
  Range range_x = no_range(kBeyond), range_y = no_range(kBeyond);
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Vec px = hn::Load(f, in_x + i), py = hn::Load(f, in_y + i), pz = hn::Load(f, in_z + i);
    const Vec z = transform(m + 8, px, py, pz);
    const Vec w = hn::Div(one, z);
    const Vec x =
        hn::MulAdd(hn::Mul(transform(m, px, py, pz), w), hn::Set(f, view.fx), hn::Set(f, view.cx));
    const Vec y = hn::MulAdd(hn::Mul(transform(m + 4, px, py, pz), w), hn::Set(f, view.fy),
                             hn::Set(f, view.cy));
    const Mask valid = hn::And(within_depth(z), hn::And(within_guard(x), within_guard(y)));
    range_x.add(valid, x);
    range_y.add(valid, y);
    hn::StoreInterleaved4(hn::IfThenElseZero(valid, x), hn::IfThenElseZero(valid, y),
                          hn::IfThenElseZero(valid, w), zero, f, records + i * kRecord);
  }
  range = {range_x.lowest(), range_x.highest(), range_y.lowest(), range_y.highest()};
}

void project_both(const float* in_x, const float* in_y, const float* in_z, std::size_t count,
                  const ViewProjection* views, float* records, PixelRange* ranges) {
  const ViewProjection& left = views[0];
  const ViewProjection& right = views[1];
  const Vec one = hn::Set(f, 1.0f);
  // x_right = cx_right + fx (X + t) / Z = x_left + (cx_right - cx_left) + fx t / Z.
  const Vec shift = hn::Set(f, right.cx - left.cx);
  const Vec parallax = hn::Set(f, right.fx * right.camera_from_first[3]);
  Range range_left = no_range(kBeyond), range_right = no_range(kBeyond),
        range_y = no_range(kBeyond);
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Vec z = hn::Load(f, in_z + i);
    const Vec w = hn::Div(one, z);
    const Vec x =
        hn::MulAdd(hn::Mul(hn::Load(f, in_x + i), w), hn::Set(f, left.fx), hn::Set(f, left.cx));
    const Vec y =
        hn::MulAdd(hn::Mul(hn::Load(f, in_y + i), w), hn::Set(f, left.fy), hn::Set(f, left.cy));
    const Vec x_right = hn::MulAdd(parallax, w, hn::Add(x, shift));
    const Mask valid = hn::And(hn::And(within_depth(z), within_guard(x_right)),
                               hn::And(within_guard(x), within_guard(y)));
    range_left.add(valid, x);
    range_right.add(valid, x_right);
    range_y.add(valid, y);
    hn::StoreInterleaved4(hn::IfThenElseZero(valid, x), hn::IfThenElseZero(valid, y),
                          hn::IfThenElseZero(valid, w), hn::IfThenElseZero(valid, x_right), f,
                          records + i * kRecord);
  }
  const float low_y = range_y.lowest(), high_y = range_y.highest();
  ranges[0] = {range_left.lowest(), range_left.highest(), low_y, high_y};
  ranges[1] = {range_right.lowest(), range_right.highest(), low_y, high_y};
}

const char* target_name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace hypotrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack {
namespace {
HWY_EXPORT(skin);
HWY_EXPORT(project_one);
HWY_EXPORT(project_both);
HWY_EXPORT(target_name);
}  // namespace

void skin_blocks(const SkinBlocks& blocks, const float* bones, float* x, float* y, float* z) {
  HWY_DYNAMIC_DISPATCH(skin)(blocks, bones, x, y, z);
}

void project_view(const float* x, const float* y, const float* z, std::size_t count,
                  const ViewProjection& view, float* records, PixelRange& range) {
  HWY_DYNAMIC_DISPATCH(project_one)(x, y, z, count, view, records, range);
}

void project_pair(const float* x, const float* y, const float* z, std::size_t count,
                  const ViewProjection* views, float* records, PixelRange* ranges) {
  HWY_DYNAMIC_DISPATCH(project_both)(x, y, z, count, views, records, ranges);
}

std::int64_t compiled_simd_targets() { return HWY_TARGETS; }

const char* simd_target() { return HWY_DYNAMIC_DISPATCH(target_name)(); }

}  // namespace hypotrack
#endif
