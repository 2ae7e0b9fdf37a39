// SPDX-License-Identifier: Apache-2.0
// Range noise on the device: table of the normal transform and σ table (Algorithm 1).
#ifndef VANTAGE_SHARED_NOISE_TYPES_H
#define VANTAGE_SHARED_NOISE_TYPES_H
#include "host.h"

VANTAGE_SHARED_BEGIN

VANTAGE_CONST uint noise_table_side = 101;  // σ table: side × side, [reflectivity][distance]

// Standard normal from 32 random bits, with multiplications and additions only, so that every device gets the same
// bits. u: sign in bit 31, m = low 31 bits; tail probability p = (m + ½)·2^−32. |z| = g(p), the quantile of the normal
// truncated at ±5:
//   g(p) = Φ⁻¹(1 − (Φ(−5) + p·(1 − 2Φ(−5)))).
// m = 0 uses row normal_octaves·normal_segments with f = 0. Else e = index of m's highest set bit, x = m << (31 − e),
// segment s = (x >> 27) & 15, f = ((x >> 3) & 0xFFFFFF)·2^−24, row = e·16 + s, and |z| = ((c3·f + c2)·f + c1)·f + c0,
// uncontracted. Row layout: c0, c1, c2, c3.
VANTAGE_CONST uint normal_octaves = 31;
VANTAGE_CONST uint normal_segments = 16;
VANTAGE_CONST uint normal_rows = normal_octaves * normal_segments + 1;
// u = philox4x32-10(key = seed, counter = {ray low, ray high, place, noise_stream})[0]
VANTAGE_CONST uint noise_stream = 0x6e6f6973u;
// The same for lost echoes: an echo is lost if u is below a limit.
VANTAGE_CONST uint dropout_stream = 0x64726f70u;

VANTAGE_SHARED_END
#endif
