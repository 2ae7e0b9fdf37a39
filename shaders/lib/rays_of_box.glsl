// SPDX-License-Identifier: Apache-2.0
// Rays of the pattern that pass a box: the inverse of the scan pattern.
#ifndef VANTAGE_LIB_RAYS_OF_BOX
#define VANTAGE_LIB_RAYS_OF_BOX
#include "lib/angles.glsl"
#include "lib/list.glsl"
#include "lib/parameters.glsl"

// Rows [row0, row1] and up to two runs of columns; the second run is beyond a full turn. Empty runs have end < begin.
// For a list: bands; the azimuth from which rays are near, and the width of those azimuths, both as bits of floats; and
// the most rays that a band has there.
struct RayWindow {
  int row0, row1;
  int column0, column1;
  int wrapped0, wrapped1;
};

int row_count_of(RayWindow w) { return max(w.row1 - w.row0 + 1, 0); }
int first_run_of(RayWindow w) { return max(w.column1 - w.column0 + 1, 0); }
int column_count_of(RayWindow w) {
  return listed ? w.wrapped0 : first_run_of(w) + max(w.wrapped1 - w.wrapped0 + 1, 0);
}

// Returns the ray at place k of a list's window; its row is no_ray if there is none.
uvec2 listed_ray_in_window(RayWindow w, uint band, uint place) {
  const BandRays rays = rays_of_band(band, intBitsToFloat(w.column0), intBitsToFloat(w.column1));
  if (place >= count_of(rays)) return uvec2(no_ray, 0u);
  const uint run = rays.end - rays.from;
  return uvec2(parameters.list_rays.at[place < run ? rays.from + place : rays.wrapped + place - run], 0u);
}

// Returns ray k of the window, row by row.
uvec2 ray_in_window(RayWindow w, int columns, int k) {
  if (listed) return listed_ray_in_window(w, uint(w.row0 + k / columns), uint(k % columns));
  const int column = k % columns, run = first_run_of(w);
  return uvec2(w.row0 + k / columns, column < run ? w.column0 + column : w.wrapped0 + column - run);
}

// Returns the zenith of a row of a pattern without a step, whose zeniths ascend; below, the first row above a zenith.
float zenith_of(uint row) { return angle_of(parameters.sin_zenith.at[row], parameters.cos_zenith.at[row]); }
int first_row_above(float zenith) {
  uint first = 0u, end = parameters.rows;
  while (first < end) {
    const uint middle = (first + end) / 2u;
    if (zenith_of(middle) > zenith)
      end = middle;
    else
      first = middle + 1u;
  }
  return int(first);
}

RayWindow window_of_grid(float zenith0, float zenith1, float start, float width) {
  const float rows = float(parameters.rows), columns = float(parameters.columns);
  RayWindow w;
  if (parameters.zenith_step > 0.0) {
    const float row_scale = 1.0 / parameters.zenith_step;
    w.row0 = int(max(ceil((zenith0 - parameters.first_zenith) * row_scale), 0.0));
    w.row1 = int(min(floor((zenith1 - parameters.first_zenith) * row_scale), rows - 1.0));
  } else {
    w.row0 = first_row_above(zenith0);
    w.row1 = first_row_above(zenith1) - 1;
  }
  const float column_scale = 1.0 / parameters.azimuth_step;
  if (width >= 1.9 * pi) {
    w.column0 = 0;
    w.column1 = int(columns) - 1;
    w.wrapped0 = 0;
    w.wrapped1 = -1;
    return w;
  }
  w.column0 = int(ceil(start * column_scale));
  w.column1 = int(min(floor((start + width) * column_scale), columns - 1.0));
  w.wrapped0 = int(max(ceil((start - 2.0 * pi) * column_scale), 0.0));
  w.wrapped1 = int(min(floor((start + width - 2.0 * pi) * column_scale), columns - 1.0));
  return w;
}

RayWindow window_of_list(float zenith0, float zenith1, float start, float width) {
  const float first = (zenith0 - parameters.first_zenith) / parameters.zenith_step,
              last = (zenith1 - parameters.first_zenith) / parameters.zenith_step;
  RayWindow w = RayWindow(int(max(floor(first), 0.0)), int(min(floor(last), float(parameters.list_bands) - 1.0)),
                          floatBitsToInt(start), floatBitsToInt(width), 0, 0);
  for (int band = w.row0; band <= w.row1; ++band)
    w.wrapped0 = max(w.wrapped0, int(count_of(rays_of_band(uint(band), start, width))));
  return w;
}

// Returns all rays from the coordinate origin that may meet the box [low, high], and few others.
RayWindow rays_of_box(vec3 low, vec3 high) {
  // Zenith: the horizontal distance is least at the box's point nearest to the axis, and largest at a corner.
  const vec2 nearest = clamp(vec2(0), low.xy, high.xy);
  const vec2 farthest = max(abs(low.xy), abs(high.xy));
  const float least = length(nearest), largest = length(farthest);
  const float zenith0 = angle_of(high.z > 0.0 ? least : largest, high.z) - angle_slack;
  const float zenith1 = angle_of(low.z > 0.0 ? largest : least, low.z) + angle_slack;

  float start = 0.0, width = 2.0 * pi;
  // A ray along the axis has every azimuth.
  if (least > angle_slack * max(abs(low.z), abs(high.z))) {
    // Corners relative to the direction of the nearest point, from which they all lie within a right angle.
    const vec2 axis = nearest;
    float lowest = pi, highest = -pi;
    for (int k = 0; k < 4; ++k) {
      const vec2 corner = vec2((k & 1) != 0 ? high.x : low.x, (k & 2) != 0 ? high.y : low.y);
      const float a = angle_of(axis.x * corner.y - axis.y * corner.x, dot(axis, corner));
      lowest = min(lowest, a);
      highest = max(highest, a);
    }
    start = angle_of(axis.y, axis.x) + lowest - angle_slack - parameters.first_azimuth;
    start -= floor(start / (2.0 * pi)) * 2.0 * pi;
    width = highest - lowest + 2.0 * angle_slack;
  }
  return listed ? window_of_list(zenith0, zenith1, start, width) : window_of_grid(zenith0, zenith1, start, width);
}

#endif
