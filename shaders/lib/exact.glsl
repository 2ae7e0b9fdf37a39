// SPDX-License-Identifier: Apache-2.0
// Arithmetic that every device rounds alike. Vulkan allows slack in division and square root, but none in + and ×.
#ifndef VANTAGE_LIB_EXACT
#define VANTAGE_LIB_EXACT

// Returns 1 / x by Newton's iteration from a guess; relative error below 2^-22. REQUIRES: 2^-100 < |x| < 2^100.
float exact_reciprocal(float x) {
  precise float y = uintBitsToFloat(0x7EF311C7u - floatBitsToUint(x));
  for (int i = 0; i < 4; ++i) {
    precise float xy = x * y;
    precise float rest = 2.0 - xy;
    y = y * rest;
  }
  return y;
}

// Returns 1 / √x by the same method. REQUIRES: 2^-100 < x < 2^100.
float exact_inverse_sqrt(float x) {
  precise float y = uintBitsToFloat(0x5F375A86u - (floatBitsToUint(x) >> 1));
  precise float half_x = 0.5 * x;
  for (int i = 0; i < 4; ++i) {
    precise float yy = y * y;
    precise float hyy = half_x * yy;
    precise float rest = 1.5 - hyy;
    y = y * rest;
  }
  return y;
}

float exact_dot(vec3 a, vec3 b) {
  precise float x = a.x * b.x;
  precise float y = a.y * b.y;
  precise float z = a.z * b.z;
  precise float xy = x + y;
  precise float sum = xy + z;
  return sum;
}

vec3 exact_cross(vec3 a, vec3 b) {
  precise vec3 p = a.yzx * b.zxy;
  precise vec3 q = a.zxy * b.yzx;
  precise vec3 r = p - q;
  return r;
}

#endif
