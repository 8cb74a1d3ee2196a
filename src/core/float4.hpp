// Four floats at once, by the vector types that g++ and clang++ share. Every operation follows IEEE 754 on
// each lane, so that results are the same bits with any instruction set.
#pragma once

#include <cmath>
#include <cstdint>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace brume {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
using Uint4 = std::uint32_t __attribute__((vector_size(16)));

inline Float4 splat(float x) {
  return Float4{x, x, x, x};
}
inline Float4 to_float(Int4 v) {
  return __builtin_convertvector(v, Float4);
}
/// Converts values below 2^31.
inline Float4 to_float(Uint4 v) {
  return __builtin_convertvector(reinterpret_cast<Int4>(v), Float4);
}
/// Rounds values within the range of Int4 towards zero.
inline Int4 to_int(Float4 v) {
  return __builtin_convertvector(v, Int4);
}
inline Int4 floor_to_int(Float4 v) {
  const Int4 cut = to_int(v);
  return cut + (to_float(cut) > v);  // a mask is -1 where it holds
}

inline Float4 min4(Float4 a, Float4 b) {
  return a < b ? a : b;
}
inline Float4 max4(Float4 a, Float4 b) {
  return a > b ? a : b;
}
inline Float4 abs4(Float4 v) {
  return reinterpret_cast<Float4>(reinterpret_cast<Uint4>(v) & 0x7fffffffu);
}
/// Values of 0 and more, with the signs of others.
inline Float4 with_sign_of(Float4 values, Float4 signs) {
  return reinterpret_cast<Float4>(reinterpret_cast<Uint4>(values) |
                                  (reinterpret_cast<Uint4>(signs) & 0x80000000u));
}
inline Float4 clamp4(Float4 v, float low, float high) {
  return min4(max4(v, splat(low)), splat(high));
}
inline Float4 sqrt4(Float4 v) {
#if defined(__SSE__)
  return _mm_sqrt_ps(v);
#endif
  return Float4{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
}
/// Bit i is set where lane i of a mask is.
inline std::uint32_t bits_of(Int4 mask) {
#if defined(__SSE__)
  return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<Float4>(mask)));
#endif
  return static_cast<std::uint32_t>((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
}
/// In a fixed order.
inline float sum4(Float4 v) {
  return (v[0] + v[1]) + (v[2] + v[3]);
}
/// Least of the first three lanes, in every lane.
inline Float4 least3(Float4 v) {
  return min4(v, min4(__builtin_shufflevector(v, v, 1, 2, 0, 0), __builtin_shufflevector(v, v, 2, 0, 1, 1)));
}

}  // namespace brume
