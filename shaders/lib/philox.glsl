// SPDX-License-Identifier: Apache-2.0
// Philox4x32-10; the same function as src/core/philox.hpp.
#ifndef VANTAGE_LIB_PHILOX
#define VANTAGE_LIB_PHILOX

uvec4 philox4x32(uvec2 key, uvec4 c) {
  for (int round = 0; round < 10; ++round) {
    uint high0, low0, high1, low1;
    umulExtended(0xD2511F53u, c.x, high0, low0);
    umulExtended(0xCD9E8D57u, c.z, high1, low1);
    c = uvec4(high1 ^ c.y ^ key.x, low1, high0 ^ c.w ^ key.y, low0);
    key += uvec2(0x9E3779B9u, 0xBB67AE85u);
  }
  return c;
}

#endif
