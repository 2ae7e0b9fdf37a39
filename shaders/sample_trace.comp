// SPDX-License-Identifier: Apache-2.0
// Traces the listed rays up to the far side of their voxel's cube and counts the points inside: one thread per ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/parameters.glsl"
#include "trace.glsl"

layout(local_size_x = group_size) in;
layout(push_constant, scalar) uniform Push { SamplePush push; };
#include "lib/sampled_point.glsl"

void main() {
  const uint k = thread_of_rows();
  const uint listed = push.control.at[push.list];
  uint slot = 0u;
  bool traced = false;
  if (listed <= push.ray_capacity && k < listed) {
    const SampleRay job = push.rays.at[k];
    const uint of_voxel = push.pairs.at[job.pair].voxel;
    slot = push.pairs.at[job.pair].slot;
    const SampleStation station = push.stations.at[slot];
    // Since listing, other rays may have filled the voxel and proved that the station sees it.
    traced = !is_closed(station, of_voxel);
    if (traced) {
      const SampleVoxel voxel = push.voxels.at[of_voxel];
      const vec3 direction = ray_direction(job.ray / parameters.columns, job.ray % parameters.columns, station.turn);
      const Cube cube = cube_of(voxel, station.origin);
      const Hit hit = trace_into(cube, passage(cube, direction), station.origin, direction);
      if (is_point_of(voxel, station, hit, direction, job.ray)) count_point(station, of_voxel);
    }
  }
  add_rays(traced, slot);
}
