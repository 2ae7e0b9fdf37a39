// SPDX-License-Identifier: Apache-2.0
// Traces the rays that a stage listed up to the far side of their voxel's cube, and notes with their sight how many
// left a point there and what stopped others: a thread a ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/parameters.glsl"
#include "lib/sample.glsl"
#include "lib/voxel.glsl"
#include "trace.glsl"
#include "lib/point.glsl"

layout(local_size_x = group_size) in;
layout(push_constant, scalar) uniform Push { SamplePush push; };

void main() {
  const uint k = thread_of_rows();
  const uint listed = push.control.at[control_rays + push.stage];
  if (listed > push.ray_capacity || k >= listed) return;
  const SampleRay job = push.rays.at[k];
  const SampleSight sight = push.sights.at[job.sight];
  if (sight.points >= push.stop_at) {  // since it was listed
    atomicAdd(push.sights.at[job.sight].listed, 0xFFFFFFFFu);
    return;
  }
  const SampleStation station = push.stations.at[sight.slot];
  const SampleVoxel voxel = push.voxels.at[sight.voxel];
  const uint row = job.ray / parameters.columns, column = job.ray % parameters.columns;
  const vec3 direction = ray_direction(row, column);
  const Cube cube = cube_of(voxel, station.origin);
  const vec2 range = passage(cube, direction);
  const float reach = parameters.noise_reach + cube.slack;
  const Hit hit = trace(station.origin, direction, parameters.min_range, min(parameters.max_range, range.y + reach),
                        range.x - reach, from_the_root);
  if (hit.id == no_primitive) return;
  if (hit.t < range.x - reach) {
    // The least of those met, so that nothing depends on the order.
    if (push.stage != stage_rest) atomicMin(push.sights.at[job.sight].hider, hit.id & ~surveyed_bit);
    return;
  }
  if ((hit.id & surveyed_bit) == 0u) return;
  Look look = unseen;
  if (with_look) look = look_of(hit, direction);
  const vec3 point = point_of(hit, look, station.origin, direction, uint64_t(job.ray), station.place);
  uvec3 cell;
  if (cell_of(point, cell) && cell == uvec3(voxel.x, voxel.y, voxel.z) && misses_of(hit, look, direction) == 0u)
    atomicAdd(push.sights.at[job.sight].points, 1u);
}
