// SPDX-License-Identifier: Apache-2.0
// Float arithmetic of shaders/lib/exact.glsl, bit for bit: sums and products alone, which every device rounds alike.
#pragma once

#include <bit>
#include <cstdint>

namespace vantage {

// 1 / √x, relative error below 2^-22. REQUIRES: 2^-100 < x < 2^100.
inline float exact_inverse_sqrt(float x) {
  float y = std::bit_cast<float>(0x5F375A86u - (std::bit_cast<std::uint32_t>(x) >> 1));
  const float half_x = 0.5f * x;
  for (int i = 0; i < 4; ++i) {
    const float rest = 1.5f - half_x * (y * y);
    y = y * rest;
  }
  return y;
}

// 1 / x likewise. REQUIRES: 2^-100 < |x| < 2^100.
inline float exact_reciprocal(float x) {
  float y = std::bit_cast<float>(0x7EF311C7u - std::bit_cast<std::uint32_t>(x));
  for (int i = 0; i < 4; ++i) {
    const float rest = 2.0f - x * y;
    y = y * rest;
  }
  return y;
}

}  // namespace vantage
