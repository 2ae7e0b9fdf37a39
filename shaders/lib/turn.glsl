// SPDX-License-Identifier: Apache-2.0
// Turned scanners: turns the pattern's directions by the same products and sums on every device.
#ifndef VANTAGE_LIB_TURN
#define VANTAGE_LIB_TURN
#include "lib/exact.glsl"

layout(constant_id = 4) const bool turned = false;  // turned_constant

vec3 turn_direction(vec3 turn[3], vec3 d) {
  return vec3(exact_dot(turn[0], d), exact_dot(turn[1], d), exact_dot(turn[2], d));
}

// Replaces a box around the scanner by one in the scanner's own frame that contains it, widened by more than the
// rounding of a turned direction.
void turn_back(vec3 turn[3], inout vec3 low, inout vec3 high) {
  const vec3 middle = 0.5 * (low + high), half_size = 0.5 * (high - low);
  const vec3 reach = abs(middle) + half_size;
  const vec3 wide = abs(turn[0]) * half_size.x + abs(turn[1]) * half_size.y + abs(turn[2]) * half_size.z +
                    (reach.x + reach.y + reach.z) * (1.0 / 524288.0);
  const vec3 moved = turn[0] * middle.x + turn[1] * middle.y + turn[2] * middle.z;
  low = moved - wide;
  high = moved + wide;
}

#endif
