// SPDX-License-Identifier: Apache-2.0
// Scanners whose directions are a list: finds rays near a direction in bands of zenith, which sort rays by azimuth
// (src/trace/direction_list.hpp).
#ifndef VANTAGE_LIB_LIST
#define VANTAGE_LIB_LIST
#include "lib/angles.glsl"
#include "lib/parameters.glsl"

layout(constant_id = 7) const bool listed = false;  // listed_constant

// Rays of one band between two azimuths: [from, end), and [wrapped, wrapped_end) beyond a full turn.
struct BandRays {
  uint from, end;
  uint wrapped, wrapped_end;
};
uint count_of(BandRays rays) { return rays.end - rays.from + rays.wrapped_end - rays.wrapped; }

// Returns the first ray of a band at the azimuth or above; `beyond`: only above.
uint place_in_band(uint first, uint end, float azimuth, bool beyond) {
  while (first < end) {
    const uint middle = (first + end) / 2u;
    const float own = parameters.list_azimuths.at[middle];
    if (beyond ? own > azimuth : own >= azimuth)
      end = middle;
    else
      first = middle + 1u;
  }
  return first;
}

// Returns the rays of a band between two azimuths. `start` is in a full turn from 0.
BandRays rays_of_band(uint band, float start, float width) {
  const uint first = parameters.list_offsets.at[band], end = parameters.list_offsets.at[band + 1u];
  if (width >= 2.0 * pi) return BandRays(first, end, first, first);
  BandRays rays;
  const float last = start + width;
  rays.from = place_in_band(first, end, start, false);
  rays.end = place_in_band(rays.from, end, last, true);
  rays.wrapped = first;
  rays.wrapped_end = last < 2.0 * pi ? first : place_in_band(first, rays.from, last - 2.0 * pi, true);
  return rays;
}

#endif
