// SPDX-License-Identifier: Apache-2.0
// Widening of boxes relative to their triangles.
#ifndef VANTAGE_LIB_WIDENING
#define VANTAGE_LIB_WIDENING
#include "lib/parameters.glsl"

// Returns more than the rounding of shear and slabs: 2^-19 of the largest coordinate involved.
float widening_of(vec3 origin) {
  const vec3 extent = max(max(abs(parameters.bounds_min), abs(parameters.bounds_max)), abs(origin));
  return max(max(extent.x, extent.y), extent.z) * (1.0 / 524288.0);
}

#endif
