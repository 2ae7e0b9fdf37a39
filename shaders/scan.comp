// SPDX-License-Identifier: Apache-2.0
// Scans rows of one station into the requested arrays: one thread per ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/parameters.glsl"
#include "lib/pattern.glsl"
#include "lib/voxel.glsl"
#include "trace.glsl"
#include "lib/point.glsl"

layout(local_size_x = group_size) in;  // block_columns × block_rows
layout(push_constant, scalar) uniform Push { ScanPush push; };

void main() {
  const uvec2 ray = ray_of_thread(push.first_row);
  const uint row = ray.x, column = ray.y;
  if (row >= push.first_row + push.row_count || column >= parameters.columns) return;
  const uint k = (row - push.first_row) * parameters.columns + column;

  const vec3 direction = ray_direction(row, column, push.turn);
  Hit hit = trace(push.origin, direction, parameters.min_range, parameters.max_range, want_nearest, from_the_root);
  const Passed passed = pass_glass(push.origin, direction, hit.t);
  const bool on_pane = passed.pane.id != no_primitive && passed.pane.t >= parameters.min_range;
  if (on_pane) hit = passed.pane;
  bool is_point = hit.id != no_primitive;
  uint misses = 0u;
  float t = uintBitsToFloat(0x7F800000u);
  Look look = unseen;
  uint voxel_index = no_voxel_index;
  vec3 position = vec3(uintBitsToFloat(0x7FC00000u));
  if (is_point) {
    if (with_look || GIVEN(push.normal) || GIVEN(push.reflectivity)) look = look_of(hit, direction);
    if (!on_pane)
      misses = misses_of(hit, look, direction, passed.share, ray_number(row, column), push.place);
    else if (with_limits && is_lost(ray_number(row, column), push.place))
      misses = misses_echo;
    if ((misses & misses_echo) != 0u) {
      is_point = false;
      look = unseen;
    }
  }
  if (is_point) {
    t = range_of(hit, look, ray_number(row, column), push.place);
    position = point_on_ray(push.origin, direction, t);
    if (GIVEN(push.voxel) && (hit.id & surveyed_bit) != 0u && misses == 0u)
      voxel_index = index_of(position);
  }
  if (GIVEN(push.range)) push.range.at[k] = t;
  if (GIVEN(push.position)) push.position.at[k] = position;
  if (GIVEN(push.normal)) push.normal.at[k] = look.normal;
  if (GIVEN(push.reflectivity)) push.reflectivity.at[k] = look.reflectivity;
  if (GIVEN(push.primitive)) push.primitive.at[k] = is_point ? hit.id & ~surveyed_bit : no_primitive;
  if (GIVEN(push.barycentric)) {
    vec2 weights = is_point ? hit.barycentric : vec2(0);
    if (with_shared && is_point && is_mirrored(hit.id & ~surveyed_bit)) weights = weights.yx;
    push.barycentric.at[k] = weights;
  }
  if (GIVEN(push.voxel)) push.voxel.at[k] = voxel_index;
}
