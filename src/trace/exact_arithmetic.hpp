// SPDX-License-Identifier: Apache-2.0
// Counterpart of shaders/lib/exact.glsl, for values that host and device must round alike. Vulkan allows slack in
// division and square root, but none in + and ×.
#pragma once

#include <bit>
#include <cstdint>

namespace vantage {

// Returns 1 / x by Newton's iteration from an integer guess, to a relative 2^-22. REQUIRES: 2^-100 < |x| < 2^100.
inline float exact_reciprocal(float x) {
  float y = std::bit_cast<float>(0x7EF311C7u - std::bit_cast<std::uint32_t>(x));
  for (int i = 0; i < 4; ++i) y = y * (2.0f - x * y);
  return y;
}

// Returns 1 / √x by the same method. REQUIRES: 2^-100 < x < 2^100.
inline float exact_inverse_sqrt(float x) {
  float y = std::bit_cast<float>(0x5F375A86u - (std::bit_cast<std::uint32_t>(x) >> 1));
  const float half_x = 0.5f * x;
  for (int i = 0; i < 4; ++i) y = y * (1.5f - half_x * (y * y));
  return y;
}

}  // namespace vantage
