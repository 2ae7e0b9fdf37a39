// SPDX-License-Identifier: Apache-2.0
// The standard normal of the range noise, truncated at ±5: a table of cubics that turns 32 random bits into a number,
// with multiplications and additions only. shaders/shared/noise_types.h defines it; shaders evaluate the same rows.
#pragma once

#include <cstdint>
#include <span>

#include "shared/noise_types.h"

namespace vantage {

inline constexpr double kNormalLimit = 5;  // |z| never exceeds it

// g(p): the value that the truncated normal exceeds with probability p, for p in (0, ½]. In double, to a few ulp.
double truncated_normal_quantile(double p);

// normal_rows rows of c0, c1, c2, c3. Made once; within 1e-6 of g everywhere. Safe to call from any thread.
std::span<const float> normal_table();

// REQUIRES: rows.size() == 4 · normal_rows. Never NaN; |z| <= 5. Bit 31 of u is the sign.
inline float normal_from_bits(std::uint32_t u, std::span<const float> rows) {
  const std::uint32_t m = u & 0x7FFFFFFFu;
  std::uint32_t row = normal_octaves * normal_segments;
  float f = 0;
  if (m != 0) {
    const std::uint32_t shift = static_cast<std::uint32_t>(__builtin_clz(m));  // 31 − e
    const std::uint32_t x = m << shift;
    row = (31 - shift) * normal_segments + ((x >> 27) & 15u);
    f = static_cast<float>((x >> 3) & 0xFFFFFFu) * 0x1p-24f;
  }
  const float* c = rows.data() + std::size_t{4} * row;
  const float z = ((c[3] * f + c[2]) * f + c[1]) * f + c[0];
  return (u & 0x80000000u) != 0 ? -z : z;
}

}  // namespace vantage
