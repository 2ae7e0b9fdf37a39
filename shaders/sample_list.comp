// SPDX-License-Identifier: Apache-2.0
// Lists the rays of the real pattern that may put a point into a sampled voxel, of pairs of slot and voxel. How many
// rays pass a cube differs much from pair to pair, so the threads of a subgroup share out all rays of their pairs
// evenly.
//
// A pair with very many rays is a sight: just a part of them, spread out over the cube, is listed at first. When that
// has been traced, the same code with SIGHTS defined queues the parts of those sights that are still open, a thread a
// sight; with QUEUE defined it works through the queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/parameters.glsl"
#include "lib/sample.glsl"
#include "lib/sheared_triangle.glsl"

layout(local_size_x = group_size) in;
layout(push_constant, scalar) uniform Push { SamplePush push; };

// Whether the ray passes near enough to the triangle that any engine might report a hit. The tolerance is 2^-16 of the
// largest coordinate, tens of times the rounding of the engines' own tests.
bool may_hit(Shear shear, vec3 origin, SampleTriangle triangle) {
  const ShearedTriangle t = sheared(shear, origin, triangle.a, triangle.b, triangle.c);
  const vec3 edges = edge_functions(t);
  const vec3 a = abs(t.a), b = abs(t.b), c = abs(t.c);
  // Shears are at most 1, so no coordinate was larger than this before.
  const float reach = max(max(max(a.x, a.y) + a.z, max(b.x, b.y) + b.z), max(c.x, c.y) + c.z) * (1.0 / 65536.0);
  const vec3 sums = vec3(a.x + a.y, b.x + b.y, c.x + c.y);
  const vec3 slack = reach * (sums.yxx + sums.zzy + reach);
  return all(greaterThanEqual(edges, -slack)) || all(lessThanEqual(edges, slack));
}

// No point of a hit nearer than t is moved further than this.
float reach_within(float t) {
  if (parameters.noise_reach == 0.0) return 0.0;
  return parameters.noise_reaches.at[reach_column(t, parameters.noise_min_range, parameters.noise_inverse_span)];
}

// One past the triangles that a point in the cube may come from: noise is small near the station, and the lists are
// made for any distance.
uint end_of_triangles(Cube cube, uint first_triangle, uint end_triangle) {
  const float farthest = length(max(abs(cube.low), abs(cube.high)));
  const float limit = reach_within(farthest + parameters.noise_reach) + 4.0 * cube.slack;
  uint end = first_triangle;
  while (end < end_triangle && push.triangles.at[end].gap <= limit) ++end;
  return end;
}

bool is_candidate(Cube cube, vec3 origin, vec3 d, uint first_triangle, uint end_triangle) {
  const vec2 range = passage(cube, d);
  if (range.x > range.y || range.y + parameters.noise_reach < parameters.min_range ||
      range.x - parameters.noise_reach > parameters.max_range)
    return false;
  const Shear shear = shear_along(d);
  for (uint t = first_triangle; t < end_triangle; ++t)
    if (may_hit(shear, origin, push.triangles.at[t])) return true;
  return false;
}

// The step of a walk that comes by all of `count` rays, none twice, and spreads the first of them out.
uint step_of(uint count) {
  if (count <= sample_part) return 1u;
  uint step = uint(0.618034 * float(count));
  for (;; ++step) {
    uint a = count, b = step;
    while (b != 0u) {
      const uint rest = a % b;
      a = b;
      b = rest;
    }
    if (a == 1u) return step;
  }
}

// What the threads of a workgroup tell each other of their pairs.
shared Cube cubes[group_size];
shared uint slots[group_size];
shared RayWindow windows[group_size];
shared uvec4 walks[group_size];  // columns, rays of the window, step and start
shared uvec2 triangles[group_size];
shared uint ends[group_size];  // of the thread's rays among those of the subgroup
shared uvec2 founds[group_size];  // a bit a ray

uvec2 ray_of(uint thread, uint k) {
  const uvec4 walk = walks[thread];
  uint at = walk.w + k;
  if (walk.y > sample_part) {
    const bool short_walk = walk.y < 1u << 25;  // 32 bits hold any place of it
    at = short_walk ? (k * walk.z + walk.w) % walk.y : uint((uint64_t(k) * walk.z + walk.w) % walk.y);
  }
  return ray_in_window(windows[thread], int(walk.x), int(at));
}

#ifdef SIGHTS
// A sight is closed when the voxel is full and its station is known to see it.
void main() {
  const uint k = thread_of_rows();
  if (k >= push.control.at[control_sights]) return;
  const SampleSight sight = push.sights.at[k];
  const SampleStation station = push.stations.at[sight.slot];
  if (push.stop_at > 0u && push.counts.at[station.network * push.voxel_count + sight.voxel] >= push.stop_at) {
    if (push.mask_words == 0u) return;
    const uint words = station.network * push.mask_words + ((station.place & 63u) >> 5);
    const uint word = words * push.voxel_count + sight.voxel;
    if ((push.masks.at[word] >> (station.place & 31u) & 1u) != 0u) return;
  }
  const uint parts = (sight.count - sight.walked + sample_part - 1u) / sample_part;
  const uint at = atomicAdd(push.control.at[control_items], parts);
  for (uint p = 0u; p < parts; ++p) push.items.at[at + p] = SampleItem(k, p);
}
#else
void main() {
#ifdef QUEUE
  const uint k = thread_of_rows();
  const bool alive = k < push.control.at[control_items];
  SampleItem item = SampleItem(0u, 0u);
  if (alive) item = push.items.at[k];
  const SampleSight sight = push.sights.at[item.sight];
  const uint of_voxel = sight.voxel, slot = sight.slot;
#else
  const uint thread_voxel = push.first_voxel + gl_WorkGroupID.x * group_size + gl_LocalInvocationIndex;
  const bool alive = thread_voxel < push.end_voxel;
  const uint of_voxel = alive ? thread_voxel : push.first_voxel, slot = push.first_slot + gl_WorkGroupID.y;
#endif
  const SampleVoxel voxel = push.voxels.at[of_voxel];
  const SampleStation station = push.stations.at[slot];
  const vec3 origin = station.origin;
  const Cube cube = cube_of(voxel, origin);
  const uint end_triangle = end_of_triangles(cube, voxel.first_triangle, push.voxels.at[of_voxel + 1u].first_triangle);

  const uint self = gl_LocalInvocationIndex;
  uint mine = 0u;  // rays to look at
  if (alive && end_triangle > voxel.first_triangle) {
    vec3 low = cube.low, high = cube.high;
    if (turned) turn_back(station.turn, low, high);
    RayWindow window = rays_of_box(low, high);
    window.row0 = max(window.row0, int(push.first_row));
    window.row1 = min(window.row1, int(push.end_row) - 1);
    // 64 bits would be needed only for patterns of over 2^31 rays, which the host refuses.
    const int rows = row_count_of(window), columns = column_count_of(window);
    const uint count = uint(rows * columns), step = step_of(count);
    uint start = count <= sample_part ? 0u : uint(rows / 2 * columns + columns / 2);
#ifdef QUEUE
    const uint from = sight.walked + item.part * sample_part;
    mine = min(sample_part, count - from);
    start = uint((uint64_t(from) * step + start) % count);
#else
    mine = count;
    if (count > sample_part) {
      // Where all are wanted, none first.
      mine = push.stop_at > 0u ? sample_part : 0u;
      const uint parts = (count - mine + sample_part - 1u) / sample_part;
      const uint known = atomicAdd(push.control.at[control_parts], parts);
      if (known + parts <= push.item_capacity)
        push.sights.at[atomicAdd(push.control.at[control_sights], 1u)] = SampleSight(of_voxel, slot, mine, count);
    }
#endif
    cubes[self] = cube;
    slots[self] = slot;
    windows[self] = window;
    walks[self] = uvec4(columns, count, step, start);
    triangles[self] = uvec2(voxel.first_triangle, end_triangle);
  }
  const uint first = subgroupMin(self), threads = subgroupAdd(1u), rank = subgroupExclusiveAdd(1u);  // of the subgroup
  const uint end = subgroupInclusiveAdd(mine), all = subgroupMax(end);
  ends[self] = end;
  founds[self] = uvec2(0u);
  subgroupBarrier();
  for (uint j = rank; j < all; j += threads) {
    // The first thread whose rays end behind j.
    uint low = first, high = first + threads - 1u;
    while (low < high) {
      const uint middle = (low + high) / 2u;
      if (ends[middle] > j) high = middle;
      else low = middle + 1u;
    }
    const uint k = j - (low == first ? 0u : ends[low - 1u]);
    const uvec2 ray = ray_of(low, k);
    const SampleStation from = push.stations.at[slots[low]];
    const vec3 direction = ray_direction(ray.x, ray.y, from.turn);
    if (!is_candidate(cubes[low], from.origin, direction, triangles[low].x, triangles[low].y)) continue;
    if (k < 32u) atomicOr(founds[low].x, 1u << k);
    else atomicOr(founds[low].y, 1u << (k - 32u));
  }
  subgroupBarrier();

  // One atomic a subgroup.
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
    const uvec2 ray = ray_of(self, uint(bit));
    if (at < push.ray_capacity) push.rays.at[at] = SampleRay(of_voxel, slot, ray.x * parameters.columns + ray.y);
    ++at;
  }
}
#endif
