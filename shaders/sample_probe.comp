// SPDX-License-Identifier: Apache-2.0
// Traces one ray of every pair of slot and voxel, through the middle of the voxel, and lists the pairs that are still
// open: one thread per pair. Most pairs are then decided: hidden, or seen in a voxel that has all the points it needs.
// Neighbouring threads have the same voxel and neighbouring stations, so that their rays are similar.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/parameters.glsl"
#include "trace.glsl"

layout(local_size_x = group_size) in;
layout(constant_id = 3) const bool watertight = false;  // true if the engine is watertight
layout(push_constant, scalar) uniform Push { SampleProbePush push; };
#include "lib/occluder.glsl"
#include "lib/sampled_point.glsl"

void main() {
  const uint k = thread_of_rows(), slots = push.end_slot - push.first_slot;
  const bool alive = k / slots < push.end_voxel - push.first_voxel;
  const uint at_voxel = push.first_voxel + (alive ? k / slots : 0u), slot = push.first_slot + (alive ? k % slots : 0u);
  const SampleVoxel voxel = push.voxels.at[at_voxel];
  const uint of_voxel = voxel.index;
  const SampleStation station = push.stations.at[slot];
  const Cube cube = cube_of(voxel, station.origin);
  bool open = false, traced = false;
  uint probe = no_ray, occluder = not_occluded;
  RayWindow window;
  if (alive && !is_closed(station, of_voxel)) {
    window = window_of(cube, station);
    const int columns = column_count_of(window);
    const uint rays = rays_of(window);
    open = rays > 0u;
    if (open) {
      const uvec2 ray =
          ray_in_window(window, columns, row_count_of(window) / 2 * columns + (listed ? columns - 1 : columns) / 2);
      const bool is_ray = ray.x != no_ray;
      const vec3 direction = is_ray ? ray_direction(ray.x, ray.y, station.turn) : vec3(0, 0, 1);
      const vec2 range = passage(cube, direction);
      open = rays > 1u || !is_ray;
      traced = is_ray && may_see(cube, range);
      if (traced) {
        probe = number_of(ray);
        const Hit hit = trace_into(cube, range, station.origin, direction);
        if (hit.id != no_primitive && hit.t < range.x - reach_of(cube)) {
          const Corners corners = corners_of(hit.id & ~surveyed_bit, station.origin);
          if (open && is_before(corners, cube)) {
            occluder = hit.id & ~surveyed_bit;
            open = watertight ? !patch_covers(occluder, station.origin, cube) : !covers(occluder_of(corners), cube);
          }
        } else if (push.probed == 0u && is_point_of(voxel, station, hit, direction, probe)) {
          const uint points = count_point(station, of_voxel);
          if (push.stop_at > 0u && points >= push.stop_at) open = false;
        }
      }
    }
  }
  const uint before = subgroupExclusiveAdd(open ? 1u : 0u), sum = subgroupAdd(open ? 1u : 0u);
  const uint probed = subgroupAdd(traced ? 1u : 0u);
  uint base = 0u;
  if (subgroupElect()) {
    if (sum > 0u) base = atomicAdd(push.control.at[control_pairs], sum);
    if (probed > 0u) atomicAdd(push.control.at[control_probed], probed);
  }
  const uint at = subgroupBroadcastFirst(base) + before;
  if (open && at < push.pair_capacity)
    push.pairs.at[at] =
        SamplePair(of_voxel, slot, probe, occluder,
                   int[6](window.row0, window.row1, window.column0, window.column1, window.wrapped0, window.wrapped1));
  // Adds one by one: threads of a subgroup have adjacent slots and many networks, so sums would save no addition.
  if (traced && push.probed == 0u) add64(push.slot_rays, 2u * slot, 1u);
}
