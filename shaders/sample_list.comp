// SPDX-License-Identifier: Apache-2.0
// Lists the rays of the real pattern that may put a point into a sampled voxel. A thread a pair of slot and voxel;
// pairs with many rays are queued in parts, and the same code with QUEUE defined works through the queue, a thread a
// part.
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

void main() {
#ifdef QUEUE
  const uint k = thread_of_rows();
  const uint queued = push.control.at[control_items];
  const bool alive = queued <= push.item_capacity && k < queued;
  SampleItem item = SampleItem(push.first_voxel, push.first_slot, 0u);
  if (alive) item = push.items.at[k];
#else
  SampleItem item = SampleItem(push.first_voxel + gl_WorkGroupID.x * group_size + gl_LocalInvocationIndex,
                               push.first_slot + gl_WorkGroupID.y, 0u);
  const bool alive = item.voxel < push.end_voxel;
  if (!alive) item.voxel = push.first_voxel;
#endif
  const SampleVoxel voxel = push.voxels.at[item.voxel];
  const SampleStation station = push.stations.at[item.slot];
  const vec3 origin = station.origin;
  const Cube cube = cube_of(voxel, origin);
  const uint end_triangle =
      end_of_triangles(cube, voxel.first_triangle, push.voxels.at[item.voxel + 1u].first_triangle);

  uvec2 found = uvec2(0);  // a bit a ray
  RayWindow window;
  int columns = 0, first = 0;
  if (alive && end_triangle > voxel.first_triangle) {
    vec3 low = cube.low, high = cube.high;
    if (turned) turn_back(station.turn, low, high);
    window = rays_of_box(low, high);
    window.row0 = max(window.row0, int(push.first_row));
    window.row1 = min(window.row1, int(push.end_row) - 1);
    columns = column_count_of(window);
    // 64 bits would be needed only for patterns of over 2^31 rays, which the host refuses.
    const int count = row_count_of(window) * columns;
#ifdef QUEUE
    first = int(item.part * sample_part);
    const int end = min(first + int(sample_part), count);
#else
    int end = count;
    if (count > int(sample_part)) {
      const uint parts = (uint(count) + sample_part - 1u) / sample_part;
      const uint at = atomicAdd(push.control.at[control_items], parts);
      for (uint p = 0; p < parts && at + p < push.item_capacity; ++p)
        push.items.at[at + p] = SampleItem(item.voxel, item.slot, p);
      end = 0;
    }
#endif
    for (int k = first; k < end; ++k) {
      const uvec2 ray = ray_in_window(window, columns, k);
      const vec3 d = ray_direction(ray.x, ray.y, station.turn);
      if (is_candidate(cube, origin, d, voxel.first_triangle, end_triangle)) {
        const int bit = k - first;
        if (bit < 32) found.x |= 1u << bit;
        else found.y |= 1u << (bit - 32);
      }
    }
  }

  // One atomic a subgroup.
  const uint mine = uint(bitCount(found.x) + bitCount(found.y));
  const uint before = subgroupExclusiveAdd(mine), all = subgroupAdd(mine);
  uint base = 0u;
  if (subgroupElect() && all > 0u) base = atomicAdd(push.control.at[control_rays], all);
  uint at = subgroupBroadcastFirst(base) + before;
  while ((found.x | found.y) != 0u) {
    const int bit = found.x != 0u ? findLSB(found.x) : 32 + findLSB(found.y);
    if (bit < 32) found.x &= found.x - 1u;
    else found.y &= found.y - 1u;
    const uvec2 ray = ray_in_window(window, columns, first + bit);
    if (at < push.ray_capacity) push.rays.at[at] = SampleRay(item.voxel, item.slot, ray.x * parameters.columns + ray.y);
    ++at;
  }
}
