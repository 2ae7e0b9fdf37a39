// SPDX-License-Identifier: Apache-2.0
// Vector types of GCC and Clang, for loops that no compiler vectorises by itself. Without such registers they become
// several narrower ones.
#pragma once

#include <cstdint>
#include <cstring>

namespace vantage {

using Floats8 = float __attribute__((vector_size(32)));
using Ints8 = std::int32_t __attribute__((vector_size(32)));
using Floats4 = float __attribute__((vector_size(16)));
using Longs4 = std::int64_t __attribute__((vector_size(32)));
using Doubles4 = double __attribute__((vector_size(32)));

// Loads from unaligned memory.
template <class Vector>
[[gnu::always_inline]] inline void load(Vector& vector, const void* from) {
  std::memcpy(&vector, from, sizeof(vector));
}
template <class Vector>
[[gnu::always_inline]] inline void store(void* to, const Vector& vector) {
  std::memcpy(to, &vector, sizeof(vector));
}
// Converts the lower and upper half to double.
[[gnu::always_inline]] inline void widen(const Floats8& v, Doubles4& low, Doubles4& high) {
  low = __builtin_convertvector(__builtin_shufflevector(v, v, 0, 1, 2, 3), Doubles4);
  high = __builtin_convertvector(__builtin_shufflevector(v, v, 4, 5, 6, 7), Doubles4);
}
[[gnu::always_inline]] inline void narrow(const Doubles4& low, const Doubles4& high, Floats8& v) {
  v = __builtin_shufflevector(__builtin_convertvector(low, Floats4), __builtin_convertvector(high, Floats4), 0, 1, 2, 3,
                              4, 5, 6, 7);
}
// Takes the lower halves of all elements.
[[gnu::always_inline]] inline void narrow(const Longs4& low, const Longs4& high, Ints8& v) {
  Ints8 a, b;
  load(a, &low);
  load(b, &high);
  v = __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14);
}
// Transposes eight rows of four elements to columns.
[[gnu::always_inline]] inline void transpose(const Floats4 (&row)[8], Floats8 (&column)[4]) {
  Floats8 pair[4];  // rows k and k + 4
  for (int k = 0; k < 4; ++k) pair[k] = __builtin_shufflevector(row[k], row[k + 4], 0, 1, 2, 3, 4, 5, 6, 7);
  const Floats8 a = __builtin_shufflevector(pair[0], pair[1], 0, 8, 1, 9, 4, 12, 5, 13),
                b = __builtin_shufflevector(pair[2], pair[3], 0, 8, 1, 9, 4, 12, 5, 13),
                c = __builtin_shufflevector(pair[0], pair[1], 2, 10, 3, 11, 6, 14, 7, 15),
                d = __builtin_shufflevector(pair[2], pair[3], 2, 10, 3, 11, 6, 14, 7, 15);
  column[0] = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
  column[1] = __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
  column[2] = __builtin_shufflevector(c, d, 0, 1, 8, 9, 4, 5, 12, 13);
  column[3] = __builtin_shufflevector(c, d, 2, 3, 10, 11, 6, 7, 14, 15);
}
// Returns true if any element of a comparison is true.
[[gnu::always_inline]] inline bool any(const Ints8& mask) {
  std::uint64_t words[4];
  store(words, mask);
  return (words[0] | words[1] | words[2] | words[3]) != 0;
}

}  // namespace vantage
