// SPDX-License-Identifier: Apache-2.0
// Lists the rays of open pairs that may put a point into the voxel: all that pass its cube and are not known to be
// stopped before. Their number varies greatly between pairs, so the threads of a subgroup share their pairs' walks
// evenly.
//
// Only the first part of a long walk is listed. Once it has been traced, the same code with SIGHTS defined queues the
// other parts of walks whose pairs are still open, one thread per pair. With QUEUE defined it works through the queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/parameters.glsl"

layout(local_size_x = group_size) in;
layout(push_constant, scalar) uniform Push { SamplePush push; };
#include "lib/occluder.glsl"
#include "lib/sample.glsl"

RayWindow window_of(SamplePair pair) {
  return RayWindow(pair.window[0], pair.window[1], pair.window[2], pair.window[3], pair.window[4], pair.window[5]);
}

// Returns the later parts of a walk: x to y, empty if x >= y. If every point is wanted, they are all of a long walk.
uvec2 later_parts(uint length) {
  if (length <= sample_part) return uvec2(0u);
  return uvec2(max(push.first_part, push.stop_at > 0u ? 1u : 0u), min(push.end_part, length / sample_part));
}

#ifdef SIGHTS
void main() {
  const uint k = thread_of_rows();
  if (k >= push.control.at[control_sights]) return;
  const uint of_pair = push.sights.at[k];
  const SamplePair pair = push.pairs.at[of_pair];
  if (is_closed(push.stations.at[pair.slot], pair.voxel)) return;
  const uvec2 parts = later_parts(walk_length(rays_of(window_of(pair))));
  const uint at = atomicAdd(push.control.at[control_items], parts.y - parts.x);
  for (uint p = parts.x; p < parts.y; ++p) push.items.at[at + p - parts.x] = SampleItem(of_pair, p);
}
#else
// Pair data that a workgroup's threads share.
struct Walk {
  int row0, column0, column1, wrapped0, columns;  // of its window
  uint rays;
  uint first;  // first step
};
shared Cube cubes[group_size];
shared uint slots[group_size];
shared Walk walks[group_size];
shared uint probes[group_size];
shared Occluder occluders[group_size];
shared uint ends[group_size];  // end of the thread's steps among those of the subgroup
shared uvec2 founds[group_size];  // one bit per step

// Finds the ray at step k of a thread; returns false if there is none.
bool ray_at(uint thread, uint k, out uvec2 ray) {
  const Walk walk = walks[thread];
  const uint place = place_in_walk(walk.first + k, walk_length(walk.rays));
  if (place >= walk.rays) return false;
  const RayWindow window = RayWindow(walk.row0, walk.row0, walk.column0, walk.column1, walk.wrapped0, walk.wrapped0);
  ray = ray_in_window(window, walk.columns, int(place));
  return ray.x != no_ray;
}

void main() {
  const uint k = thread_of_rows();
#ifdef QUEUE
  const bool alive = k < push.control.at[control_items];
  SampleItem item = SampleItem(0u, 0u);
  if (alive) item = push.items.at[k];
#else
  const bool alive = k < push.control.at[control_pairs];
  const SampleItem item = SampleItem(alive ? k : 0u, 0u);
#endif
  const SamplePair pair = push.pairs.at[item.pair];
  const SampleStation station = push.stations.at[pair.slot];
  const uint self = gl_LocalInvocationIndex;
  uint mine = 0u;  // number of own steps
  if (alive && !is_closed(station, pair.voxel)) {
    const RayWindow window = window_of(pair);
    const uint rays = rays_of(window), length = walk_length(rays);
    mine = min(length, sample_part);
#ifndef QUEUE
    const uvec2 later = later_parts(length);
    if (later.x < later.y) {
      const uint parts = later.y - later.x, earlier = atomicAdd(push.control.at[control_parts], parts);
      if (earlier + parts <= push.item_capacity)
        push.sights.at[atomicAdd(push.control.at[control_sights], 1u)] = item.pair;
    }
    if (push.first_traced != 0u || push.first_part > 0u || (length > sample_part && push.stop_at == 0u)) mine = 0u;
#endif
    cubes[self] = cube_of(push.voxels.at[pair.voxel], station.origin);
    slots[self] = pair.slot;
    walks[self] = Walk(window.row0, window.column0, window.column1, window.wrapped0, column_count_of(window), rays,
                       item.part * sample_part);
    probes[self] = pair.probe;
    occluders[self] =
        pair.occluder == not_occluded ? no_occluder : occluder_of(corners_of(pair.occluder, station.origin));
  }
  // within the subgroup
  const uint first = subgroupMin(self), threads = subgroupAdd(1u), rank = subgroupExclusiveAdd(1u);
  const uint end = subgroupInclusiveAdd(mine), all = subgroupMax(end);
  ends[self] = end;
  founds[self] = uvec2(0u);
  subgroupBarrier();
  for (uint j = rank; j < all; j += threads) {
    // Finds the first thread whose steps end after j.
    uint low = first, high = first + threads - 1u;
    while (low < high) {
      const uint middle = (low + high) / 2u;
      if (ends[middle] > j) high = middle;
      else low = middle + 1u;
    }
    const uint k = j - (low == first ? 0u : ends[low - 1u]);
    uvec2 ray;
    if (!ray_at(low, k, ray) || number_of(ray) == probes[low]) continue;
    const vec3 direction = ray_direction(ray.x, ray.y, push.stations.at[slots[low]].turn);
    if (!may_see(cubes[low], passage(cubes[low], direction)) || stops(occluders[low], direction)) continue;
    if (k < 32u) atomicOr(founds[low].x, 1u << k);
    else atomicOr(founds[low].y, 1u << (k - 32u));
  }
  subgroupBarrier();

  // One atomic per subgroup.
  uvec2 found = founds[self];
  const uint wanted = uint(bitCount(found.x) + bitCount(found.y));
  const uint before = subgroupExclusiveAdd(wanted), sum = subgroupAdd(wanted);
  uint base = 0u;
  if (subgroupElect() && sum > 0u) base = atomicAdd(push.control.at[push.list], sum);
  uint at = subgroupBroadcastFirst(base) + before;
  while ((found.x | found.y) != 0u) {
    const int bit = found.x != 0u ? findLSB(found.x) : 32 + findLSB(found.y);
    if (bit < 32) found.x &= found.x - 1u;
    else found.y &= found.y - 1u;
    uvec2 ray;
    ray_at(self, uint(bit), ray);
    if (at < push.ray_capacity) push.rays.at[at] = SampleRay(item.pair, number_of(ray));
    ++at;
  }
}
#endif
