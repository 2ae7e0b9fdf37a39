// SPDX-License-Identifier: Apache-2.0
// Traces the listed rays up to the far side of their voxel's cube and counts the points that land in it: a thread a
// ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/parameters.glsl"
#include "lib/sample.glsl"
#include "lib/voxel.glsl"
#include "trace.glsl"
#include "lib/point.glsl"

layout(local_size_x = group_size) in;
layout(constant_id = 2) const bool with_masks = true;
layout(push_constant, scalar) uniform Push { SamplePush push; };

void main() {
  const uint k = thread_of_rows();
  const uint listed = push.control.at[control_rays];
  uint network = 0u;
  bool traced = false;
  if (listed <= push.ray_capacity && k < listed) {
    const SampleRay job = push.rays.at[k];
    const SampleStation station = push.stations.at[job.slot];
    const SampleVoxel voxel = push.voxels.at[job.voxel];
    network = station.network;
    const uint entry = network * push.voxel_count + job.voxel;
    traced = push.stop_at == 0u || push.counts.at[entry] < push.stop_at;
    if (traced) {
      const uint row = job.ray / parameters.columns, column = job.ray % parameters.columns;
      const vec3 direction = ray_direction(row, column, station.turn);
      const Cube cube = cube_of(voxel, station.origin);
      const vec2 range = passage(cube, direction);
      const float reach = parameters.noise_reach + cube.slack;
      const Hit hit = trace(station.origin, direction, parameters.min_range,
                            min(parameters.max_range, range.y + reach), range.x - reach, from_the_root);
      if (hit.id != no_primitive && (hit.id & surveyed_bit) != 0u) {
        Look look = unseen;
        if (with_look) look = look_of(hit, direction);
        const vec3 point = point_of(hit, look, station.origin, direction, uint64_t(job.ray), station.place);
        uvec3 cell;
        if (cell_of(point, cell) && cell == uvec3(voxel.x, voxel.y, voxel.z) && misses_of(hit, look, direction) == 0u) {
          atomicAdd(push.counts.at[entry], 1u);
          if (with_masks) {
            const uint word = (network * push.mask_words + (station.place >> 5)) * push.voxel_count + job.voxel;
            const uint bit = 1u << (station.place & 31u);
            if ((push.masks.at[word] & bit) == 0u) atomicOr(push.masks.at[word], bit);
          }
        }
      }
    }
  }
  // Neighbouring rays mostly belong to one network: one addition a subgroup then.
  const uint lowest = subgroupMin(traced ? network : 0xFFFFFFFFu), highest = subgroupMax(traced ? network : 0u);
  const uint rays = subgroupAdd(traced ? 1u : 0u);
  if (lowest == highest) {
    if (subgroupElect()) add64(push.network_rays, 2u * lowest, rays);
  } else if (traced) {
    add64(push.network_rays, 2u * network, 1u);
  }
}
