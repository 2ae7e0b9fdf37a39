// SPDX-License-Identifier: Apache-2.0
// Decides a hit of a ray and a triangle in float only if certain; double precision can decide the rest. As in
// lib/sheared_triangle.glsl, corners are sheared so that the ray is the z axis. Here all errors are bounded, from the
// rounding of the ray to float on, so a device may fuse and divide as it likes. It may not rearrange.
//
// A corner at depth z and at distance x from the ray, with u = 2^-24, is off by at most 2u of the origin's largest
// coordinate, for rounding it in both components; 11u of z, for the direction (2u), its reciprocal (5u), products and
// differences; and 2u of x. Products in edge functions add 2u. All factors below are larger by half or more.
#ifndef VANTAGE_LIB_CROSSING
#define VANTAGE_LIB_CROSSING
#include "lib/parameters.glsl"

const float doubt_of_origin = 2.3841858e-7;  // 2^-22, a share of its largest coordinate
const float doubt_of_scene = 3.7252903e-9;   // 2^-28, of the scene's; covers double precision
const float doubt_of_depth = 9.5367432e-7;   // 2^-20, of the depth of corners
const float doubt_of_width = 4.7683716e-7;   // 2^-21, of the corners' distances from the ray
const float doubt_of_range = 1.9073486e-6;   // 2^-19, of the depth of corners; for distances
const float least_area = 1e-30;              // products below may underflow

float largest_of(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }
float scene_size() { return max(largest_of(parameters.bounds_min), largest_of(parameters.bounds_max)); }

// A ray in the frame of the scene or of a shared mesh.
struct Line {
  vec3 origin;
  bool major_x, major_y;  // the largest component of the direction becomes z
  vec2 shear;
  float along;  // distance per depth
  float doubt;  // error of a corner's place at any depth
};

Line line_along(vec3 origin, vec3 direction, float doubt) {
  const vec3 size = abs(direction);
  const bool major_x = size.x >= size.y && size.x >= size.z, major_y = !major_x && size.y >= size.z;
  const vec3 d = major_x ? direction.yzx : major_y ? direction.zxy : direction;
  precise float along = 1.0 / d.z;
  precise vec2 shear = d.xy * along;
  return Line(origin, major_x, major_y, shear, along, doubt);
}

float scene_doubt(vec3 origin) { return doubt_of_origin * largest_of(origin) + doubt_of_scene * scene_size(); }

vec3 sheared(Line line, vec3 corner) {
  precise vec3 from = corner - line.origin;
  const vec3 p = line.major_x ? from.yzx : line.major_y ? from.zxy : from;
  precise vec2 beside = fma(-line.shear, vec2(p.z), p.xy);
  return vec3(beside, p.z);
}

// Interval [near, far] in which the ray may meet the triangle, if it meets it at all.
struct Crossing {
  bool possible, sure;
  float near, far;
};

Crossing crossing_of(Line line, vec3 corner_a, vec3 corner_b, vec3 corner_c) {
  const vec3 a = sheared(line, corner_a), b = sheared(line, corner_b), c = sheared(line, corner_c);
  precise vec3 edges = vec3(fma(c.x, b.y, -(c.y * b.x)), fma(a.x, c.y, -(a.y * c.x)), fma(b.x, a.y, -(b.y * a.x)));
  const float least = min(min(edges.x, edges.y), edges.z), most = max(max(edges.x, edges.y), edges.z);
  const float low = min(min(a.z, b.z), c.z), high = max(max(a.z, b.z), c.z);
  const float depth = max(abs(low), abs(high));
  const vec2 sides = abs(a.xy) + abs(b.xy) + abs(c.xy);
  const float width = sides.x + sides.y;
  const float moved = line.doubt + doubt_of_depth * depth + doubt_of_width * width;
  const float doubt = moved * (width + 2.0 * moved) + least_area;  // of an edge function
  if (least < -doubt && most > doubt) return Crossing(false, false, 0.0, 0.0);

  const float slack = abs(line.along) * (line.doubt + doubt_of_range * depth);
  const float first = low * line.along, last = high * line.along;
  Crossing met = Crossing(true, least > doubt || most < -doubt, min(first, last) - slack, max(first, last) + slack);
  if (met.sure) {
    // Errors of all weights together are up to 12 times doubt / area; else the point may lie anywhere on the triangle.
    precise float area = edges.x + edges.y + edges.z;
    precise float share = 1.0 / area;
    precise float depths = fma(edges.x, a.z, fma(edges.y, b.z, edges.z * c.z));
    precise float t = depths * share * line.along;
    const float off = slack + 12.0 * abs(line.along * (high - low) * share) * doubt;
    met.near = max(met.near, t - off);
    met.far = min(met.far, t + off);
  }
  return met;
}

#endif
