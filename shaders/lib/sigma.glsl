// SPDX-License-Identifier: Apache-2.0
// Standard deviation of a range, from the noise table (Algorithm 1).
#ifndef VANTAGE_LIB_SIGMA
#define VANTAGE_LIB_SIGMA
#include "lib/references.glsl"

// Interpolates bilinearly in normalised distance and reflectivity, the latter within [0, 1].
float sigma_in(Floats sigma, float min_range, float inverse_span, float t, float reflectivity) {
  precise float from_start = t - min_range;
  precise float normalised = from_start * inverse_span;
  precise float x = clamp(normalised, 0.0, 1.0) * 100.0;
  precise float y = reflectivity * 100.0;
  const uint i = min(uint(x), noise_table_side - 2u), j = min(uint(y), noise_table_side - 2u);
  precise float fx = x - float(i);
  precise float fy = y - float(j);
  const uint at = j * noise_table_side + i;
  const float s00 = sigma.at[at], s01 = sigma.at[at + 1u];
  const float s10 = sigma.at[at + noise_table_side], s11 = sigma.at[at + noise_table_side + 1u];
  precise float d0 = s01 - s00;
  precise float e0 = fx * d0;
  precise float low = s00 + e0;
  precise float d1 = s11 - s10;
  precise float e1 = fx * d1;
  precise float high = s10 + e1;
  precise float d2 = high - low;
  precise float e2 = fy * d2;
  precise float s = low + e2;
  return s;
}

#endif
