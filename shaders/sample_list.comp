// SPDX-License-Identifier: Apache-2.0
// Lists rays of the real pattern that may put a point into a sampled voxel, in stages:
// - A thread a pair of slot and voxel looks for one such ray. Where there is one, the pair is a sight from then on.
// - With SIGHTS, a thread a sight goes on where the last stage stopped, unless the voxel is full: to some rays more in
//   stage_some, to all that are left in stage_rest. It passes over rays that what stopped another must stop, too.
// - With QUEUE, a thread takes a part of a sight that has too many left for one.
// The rays of a window are looked at from its middle on in golden steps, so that the first are spread out over it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/hides.glsl"
#include "lib/may_hit.glsl"
#include "lib/parameters.glsl"
#include "lib/sample.glsl"
#include "lib/sample_list.glsl"

layout(local_size_x = group_size) in;
layout(push_constant, scalar) uniform Push { SamplePush push; };

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

// What is known to have stopped a ray on its way to the cube.
struct Hider {
  bool known;
  vec3 a, b, c;
};

bool is_candidate(Cube cube, vec3 origin, uvec2 ray, uint first_triangle, uint end_triangle, Hider hider) {
  const vec3 d = ray_direction(ray.x, ray.y);
  const vec2 range = passage(cube, d);
  if (range.x > range.y || range.y + parameters.noise_reach < parameters.min_range ||
      range.x - parameters.noise_reach > parameters.max_range)
    return false;
  const Shear shear = shear_along(d);
  if (hider.known && must_hit(shear, origin, hider.a, hider.b, hider.c, parameters.min_range,
                              range.x - (parameters.noise_reach + cube.slack)))
    return false;
  for (uint t = first_triangle; t < end_triangle; ++t) {
    const SampleTriangle triangle = push.triangles.at[t];
    if (may_hit(shear, origin, triangle.a, triangle.b, triangle.c)) return true;
  }
  return false;
}

// The step of a walk that comes by all of `count` rays, none twice.
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

// How many points a station's rays need to leave in a voxel at least: of one that is full already only whether there is
// one, if that.
uint points_wanted(SampleSight sight) {
  if (push.stop_at == no_stop) return no_stop;
  const bool full = push.counts.at[push.stations.at[sight.slot].network * push.voxel_count + sight.voxel] >= push.stop_at;
  return !full ? push.stop_at : push.mask_words > 0u ? 1u : 0u;
}

void main() {
#ifdef QUEUE
  const uint k = thread_of_rows();
  const uint queued = push.control.at[control_items];
  const bool alive = queued <= push.item_capacity && k < queued;
  SampleItem item = SampleItem(0u, 0u);
  if (alive) item = push.items.at[k];
  const uint at_sight = item.sight;
  const SampleSight sight = push.sights.at[at_sight];
#elif defined(SIGHTS)
  const uint at_sight = thread_of_rows();
  const bool known = at_sight < push.control.at[control_sights];
  const SampleSight sight = push.sights.at[known ? at_sight : 0u];
  const bool alive = known && sight.points < points_wanted(sight);
#else
  const uint pair_voxel = push.first_voxel + gl_WorkGroupID.x * group_size + gl_LocalInvocationIndex;
  const bool inside = pair_voxel < push.end_voxel;
  const SampleSight sight =
      SampleSight(inside ? pair_voxel : push.first_voxel, push.first_slot + gl_WorkGroupID.y, 0u, 0u, 0u, no_primitive);
  const bool alive = inside && points_wanted(sight) > 0u;
#endif
  const SampleVoxel voxel = push.voxels.at[sight.voxel];
  const vec3 origin = push.stations.at[sight.slot].origin;
  const Cube cube = cube_of(voxel, origin);
  const uint end_triangle =
      end_of_triangles(cube, voxel.first_triangle, push.voxels.at[sight.voxel + 1u].first_triangle);

  uvec2 found = uvec2(0);  // a bit a ray
  RayWindow window;
  int columns = 0;
  uint count = 0u, from = sight.walked, step = 1u, start = 0u;
  uint walked = from;  // afterwards
  if (alive && end_triangle > voxel.first_triangle) {
    window = rays_of_box(cube.low, cube.high);
    window.row0 = max(window.row0, int(push.first_row));
    window.row1 = min(window.row1, int(push.end_row) - 1);
    columns = column_count_of(window);
    // 64 bits would be needed only for patterns of over 2^31 rays, which the host refuses.
    count = uint(row_count_of(window) * columns);
  }
  Hider hider = Hider(sight.hider != no_primitive, vec3(0), vec3(0), vec3(0));
  if (hider.known && from < count) {
    const uint corner = 3u * sight.hider;
    hider.a = parameters.positions.at[parameters.triangles.at[corner]];
    hider.b = parameters.positions.at[parameters.triangles.at[corner + 1u]];
    hider.c = parameters.positions.at[parameters.triangles.at[corner + 2u]];
#ifdef SIGHTS
    const float reach = parameters.noise_reach + cube.slack;
    if (push.stage == stage_some && hides(cube, hider.a - origin, hider.b - origin, hider.c - origin, parameters.min_range, reach))
      walked = from = count;
#endif
  }
#ifdef QUEUE
  from += item.part * sample_part;
#elif defined(SIGHTS)
  if (push.stage == stage_rest && count > from + sample_part) {
    const uint parts = (count - from + sample_part - 1u) / sample_part;
    const uint at = atomicAdd(push.control.at[control_items], parts);
    for (uint p = 0u; p < parts && at + p < push.item_capacity; ++p) push.items.at[at + p] = SampleItem(at_sight, p);
    count = 0u;
  }
#endif
  if (from < count) {
    step = step_of(count);
    start = uint((uint64_t(from) * step + (row_count_of(window) / 2 * columns + columns / 2)) % count);
    uint at = start, listed = 0u;
    const uint end = min(from + sample_part, count);
    for (walked = from; walked < end && listed < push.most; ++walked) {
      if (is_candidate(cube, origin, ray_in_window(window, columns, int(at)), voxel.first_triangle, end_triangle, hider)) {
        const uint bit = walked - from;
        if (bit < 32u) found.x |= 1u << bit;
        else found.y |= 1u << (bit - 32u);
        ++listed;
      }
      at += step;
      if (at >= count) at -= count;
    }
  }

  const uint mine = uint(bitCount(found.x) + bitCount(found.y));
#ifdef QUEUE
  if (mine > 0u) atomicAdd(push.sights.at[at_sight].listed, mine);
#elif defined(SIGHTS)
  if (alive && count > 0u) {
    push.sights.at[at_sight].walked = walked;
    push.sights.at[at_sight].listed = sight.listed + mine;
  }
#else
  const bool open = mine > 0u || walked < count;
  const uint at_sight = reserve(push.control, control_sights, open ? 1u : 0u);
  if (open) push.sights.at[at_sight] = SampleSight(sight.voxel, sight.slot, walked, mine, 0u, no_primitive);
#endif
  uint place = reserve(push.control, control_rays + push.stage, mine);
  for (uint at = start; (found.x | found.y) != 0u;) {
    if ((found.x & 1u) != 0u) {
      const uvec2 ray = ray_in_window(window, columns, int(at));
      if (place < push.ray_capacity) push.rays.at[place] = SampleRay(at_sight, ray.x * parameters.columns + ray.y);
      ++place;
    }
    found = uvec2(found.x >> 1 | found.y << 31, found.y >> 1);
    at += step;
    if (at >= count) at -= count;
  }
}
