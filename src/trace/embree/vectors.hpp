// SPDX-License-Identifier: Apache-2.0
// Vectors of GCC's and Clang's, for loops that no compiler vectorises by itself. Without such registers they become
// several narrower ones.
#pragma once

#include <cstdint>
#include <cstring>

namespace vantage {

using Floats8 = float __attribute__((vector_size(32)));
using Ints8 = std::int32_t __attribute__((vector_size(32)));
using Floats4 = float __attribute__((vector_size(16)));
using Doubles4 = double __attribute__((vector_size(32)));

// Unaligned.
template <class Vector>
[[gnu::always_inline]] inline void load(Vector& vector, const void* from) {
  std::memcpy(&vector, from, sizeof(vector));
}
template <class Vector>
[[gnu::always_inline]] inline void store(void* to, const Vector& vector) {
  std::memcpy(to, &vector, sizeof(vector));
}
// Lower and upper half, in double precision.
[[gnu::always_inline]] inline void widen(const Floats8& v, Doubles4& low, Doubles4& high) {
  low = __builtin_convertvector(__builtin_shufflevector(v, v, 0, 1, 2, 3), Doubles4);
  high = __builtin_convertvector(__builtin_shufflevector(v, v, 4, 5, 6, 7), Doubles4);
}
[[gnu::always_inline]] inline void narrow(const Doubles4& low, const Doubles4& high, Floats8& v) {
  v = __builtin_shufflevector(__builtin_convertvector(low, Floats4), __builtin_convertvector(high, Floats4), 0, 1, 2, 3,
                              4, 5, 6, 7);
}
// Whether any element of a comparison is true.
[[gnu::always_inline]] inline bool any(const Ints8& mask) {
  std::uint64_t words[4];
  store(words, mask);
  return (words[0] | words[1] | words[2] | words[3]) != 0;
}

}  // namespace vantage
