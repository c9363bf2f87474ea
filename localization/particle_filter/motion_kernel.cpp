// Compiled once for each instruction set; Highway picks at run time. No fused multiply-add (see
// CMakeLists.txt), so that a recorded run replays alike on every processor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "localization/particle_filter/motion_kernel.cpp"
#include "localization/particle_filter/motion_kernel.hpp"

#include "hwy/foreach_target.h"  // must stand before highway.h
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace madori::localization::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// 32 well-mixed bits of a counter (a multiply-xorshift finalizer, keyed twice).
template <class D, class V>
HWY_INLINE V mix(D d, V counter, const MotionStep& step) {
  auto h = hn::Xor(counter, hn::Set(d, step.key1));
  h = hn::Mul(hn::Xor(h, hn::ShiftRight<16>(h)), hn::Set(d, 0x7FEB352DU));
  h = hn::Add(h, hn::Set(d, step.key2));
  h = hn::Mul(hn::Xor(h, hn::ShiftRight<15>(h)), hn::Set(d, 0x846CA68BU));
  return hn::Xor(h, hn::ShiftRight<16>(h));
}

/// Standard normal: the sum of eight 16-bit uniforms, its kurtosis mended by a cubic (Cornish-Fisher); |z|
/// < 5.6.
template <class F, class V>
HWY_INLINE auto normal(F f, V first, const MotionStep& step) {
  const hn::RebindToUnsigned<F> u;
  const hn::RebindToSigned<F> i;
  auto sum = hn::Zero(u);
  for (std::uint32_t k = 0; k < 4; ++k) {
    const auto bits = mix(u, hn::Add(first, hn::Set(u, k)), step);
    sum = hn::Add(sum, hn::Add(hn::And(bits, hn::Set(u, 0xFFFFU)), hn::ShiftRight<16>(bits)));
  }
  const auto centred = hn::Sub(hn::ConvertTo(f, hn::BitCast(i, sum)), hn::Set(f, 262140.0F));
  const auto z = hn::Mul(centred, hn::Set(f, 1.0F / 53510.6F));
  const auto cubic = hn::Mul(z, hn::Sub(hn::Mul(z, z), hn::Set(f, 3.0F)));
  return hn::Add(z, hn::Mul(cubic, hn::Set(f, 0.00625F)));
}

/// Sine and cosine to about 1e-6: the angle's quarter turn, and polynomials within an eighth.
template <class F, class V>
HWY_INLINE void sine_cosine(F f, V angle, V& sine, V& cosine) {
  const hn::RebindToSigned<F> i;
  const auto quarters = hn::Round(hn::Mul(angle, hn::Set(f, 0.63661977236758134F)));
  auto x = hn::Sub(angle, hn::Mul(quarters, hn::Set(f, 1.5707855224609375F)));  // pi/2 in two parts
  x = hn::Sub(x, hn::Mul(quarters, hn::Set(f, 1.0804334124e-5F)));
  const auto x2 = hn::Mul(x, x);
  auto s = hn::Add(hn::Mul(x2, hn::Set(f, -1.9515296e-4F)), hn::Set(f, 8.3321609e-3F));
  s = hn::Add(hn::Mul(x2, s), hn::Set(f, -1.6666655e-1F));
  s = hn::Add(x, hn::Mul(hn::Mul(x, x2), s));
  auto c = hn::Add(hn::Mul(x2, hn::Set(f, 2.4433157e-5F)), hn::Set(f, -1.3887316e-3F));
  c = hn::Add(hn::Mul(x2, c), hn::Set(f, 4.1666646e-2F));
  c = hn::Add(hn::Sub(hn::Set(f, 1.0F), hn::Mul(x2, hn::Set(f, 0.5F))), hn::Mul(hn::Mul(x2, x2), c));
  const auto n = hn::ConvertTo(i, quarters);
  const auto one = hn::Set(i, 1);
  const auto two = hn::Set(i, 2);
  const auto odd = hn::RebindMask(f, hn::Eq(hn::And(n, one), one));
  const auto flip_s = hn::RebindMask(f, hn::Eq(hn::And(n, two), two));
  const auto flip_c = hn::RebindMask(f, hn::Eq(hn::And(hn::Add(n, one), two), two));
  const auto s0 = hn::IfThenElse(odd, c, s);
  const auto c0 = hn::IfThenElse(odd, s, c);
  sine = hn::IfThenElse(flip_s, hn::Neg(s0), s0);
  cosine = hn::IfThenElse(flip_c, hn::Neg(c0), c0);
}

template <class F>
HWY_INLINE void move_lanes(F f, const MotionStep& step, float* x_m, float* y_m, float* yaw_rad,
                           std::size_t p) {
  const hn::RebindToUnsigned<F> u;
  constexpr std::uint32_t kDraws = 12;  // four for each of three normals
  const auto first = hn::Mul(hn::Iota(u, static_cast<std::uint32_t>(p)), hn::Set(u, kDraws));
  const auto zx = normal(f, first, step);
  const auto zy = normal(f, hn::Add(first, hn::Set(u, 4U)), step);
  const auto zt = normal(f, hn::Add(first, hn::Set(u, 8U)), step);
  const auto scaled = [&](std::size_t k, auto z) { return hn::Mul(hn::Set(f, step.lower[k]), z); };
  const auto dx = hn::Add(hn::Set(f, step.mean[0]), scaled(0, zx));
  const auto dy = hn::Add(hn::Add(hn::Set(f, step.mean[1]), scaled(1, zx)), scaled(2, zy));
  const auto dt =
      hn::Add(hn::Add(hn::Add(hn::Set(f, step.mean[2]), scaled(3, zx)), scaled(4, zy)), scaled(5, zt));
  const auto yaw = hn::LoadU(f, yaw_rad + p);
  auto s = hn::Zero(f), c = hn::Zero(f);
  sine_cosine(f, yaw, s, c);
  hn::StoreU(hn::Add(hn::LoadU(f, x_m + p), hn::Sub(hn::Mul(c, dx), hn::Mul(s, dy))), f, x_m + p);
  hn::StoreU(hn::Add(hn::LoadU(f, y_m + p), hn::Add(hn::Mul(s, dx), hn::Mul(c, dy))), f, y_m + p);
  hn::StoreU(hn::Add(yaw, dt), f, yaw_rad + p);
}

void move_all(const MotionStep& step, float* x_m, float* y_m, float* yaw_rad, std::size_t count) {
  const hn::ScalableTag<float> f;
  std::size_t p = 0;
  for (; p + hn::Lanes(f) <= count; p += hn::Lanes(f)) move_lanes(f, step, x_m, y_m, yaw_rad, p);
  const hn::CappedTag<float, 1> one;
  for (; p < count; ++p) move_lanes(one, step, x_m, y_m, yaw_rad, p);
}

void move_one_by_one(const MotionStep& step, float* x_m, float* y_m, float* yaw_rad, std::size_t count) {
  const hn::CappedTag<float, 1> one;
  for (std::size_t p = 0; p < count; ++p) move_lanes(one, step, x_m, y_m, yaw_rad, p);
}

}  // namespace madori::localization::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace madori::localization {

HWY_EXPORT(move_all);

void move_particles(const MotionStep& step, float* x_m, float* y_m, float* yaw_rad, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(move_all)(step, x_m, y_m, yaw_rad, count);
}
void move_particles_scalar(const MotionStep& step, float* x_m, float* y_m, float* yaw_rad,
                           std::size_t count) {
  HWY_STATIC_DISPATCH(move_one_by_one)(step, x_m, y_m, yaw_rad, count);
}

}  // namespace madori::localization
#endif
