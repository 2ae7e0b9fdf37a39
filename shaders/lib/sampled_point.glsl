// SPDX-License-Identifier: Apache-2.0
// Traces a ray for a sampled voxel and counts its point. For kernels with an engine's trace() and `push`.
#ifndef VANTAGE_LIB_SAMPLED_POINT
#define VANTAGE_LIB_SAMPLED_POINT
#include "lib/point.glsl"
#include "lib/sample.glsl"
#include "lib/voxel.glsl"

layout(constant_id = 2) const bool with_masks = true;

// Traces up to the far side of the cube that the ray crosses from range.x to range.y.
Hit trace_into(Cube cube, vec2 range, vec3 origin, vec3 direction) {
  const float reach = reach_of(cube);
  return trace(origin, direction, parameters.min_range, min(parameters.max_range, range.y + reach), range.x - reach,
               from_the_root);
}

// Returns true if the hit's point lies in the voxel and counts.
bool is_point_of(SampleVoxel voxel, SampleStation station, Hit hit, vec3 direction, uint ray) {
  if (hit.id == no_primitive || (hit.id & surveyed_bit) == 0u) return false;
  Look look = unseen;
  if (with_look) look = look_of(hit, direction);
  const vec3 point = point_of(hit, look, station.origin, direction, uint64_t(ray), station.place);
  uvec3 cell;
  if (!cell_of(point, cell) || cell != uvec3(voxel.x, voxel.y, voxel.z)) return false;
  return misses_of(hit, look, direction, pass_glass(station.origin, direction, hit.t).share, uint64_t(ray),
                   station.place) == 0u;
}

// Counts a point. Returns the voxel's number of points after that, or a few more.
uint count_point(SampleStation station, uint voxel) {
  const uint before = atomicAdd(push.counts.at[station.network * push.voxel_count + voxel], 1u);
  if (with_masks && !is_seen(station, voxel)) atomicOr(push.masks.at[mask_word(station, voxel)], mask_bit(station));
  return before + 1u;
}

#endif
