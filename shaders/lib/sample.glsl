// SPDX-License-Identifier: Apache-2.0
// Shared by the kernels of sampled evaluation: the cube of a sampled voxel as a station sees it, and the rays that pass
// it. Include after `push` is declared.
#ifndef VANTAGE_LIB_SAMPLE
#define VANTAGE_LIB_SAMPLE
#include "lib/cube.glsl"
#include "lib/pattern.glsl"
#include "lib/rays_of_box.glsl"

// Returns the word with a station's bit of a voxel.
uint mask_word(SampleStation station, uint voxel) {
  return (station.network * push.mask_words + ((station.place & 63u) >> 5)) * push.voxel_count + voxel;
}
uint mask_bit(SampleStation station) { return 1u << (station.place & 31u); }
bool is_seen(SampleStation station, uint voxel) {
  return (push.masks.at[mask_word(station, voxel)] & mask_bit(station)) != 0u;
}

// Returns true if no ray of the pair changes anything: the voxel is full, and its station is known to see it.
bool is_closed(SampleStation station, uint voxel) {
  return push.stop_at > 0u && push.counts.at[station.network * push.voxel_count + voxel] >= push.stop_at &&
         (push.mask_words == 0u || is_seen(station, voxel));
}

// Returns true if the ray may put a point into a cube that it crosses from range.x to range.y.
bool may_see(Cube cube, vec2 range) {
  return range.x <= range.y && range.y + cube.noise >= parameters.min_range &&
         range.x - cube.noise <= parameters.max_range;
}

// Returns all rays that may meet the cube, and few others.
RayWindow window_of(Cube cube, SampleStation station) {
  vec3 low = cube.low, high = high_of(cube);
  if (turned) turn_back(station.turn, low, high);
  return rays_of_box(low, high);
}
// Fits 32 bits, since the host rejects patterns of over 2^31 rays.
uint rays_of(RayWindow window) { return uint(row_count_of(window) * column_count_of(window)); }
uint number_of(uvec2 ray) { return ray.x * parameters.columns + ray.y; }

// A walk visits all rays of a window once. A long walk steps by the golden ratio through a power of two, so that its
// first steps are spread out; some of its positions hold no ray.
uint walk_length(uint rays) { return rays <= sample_part ? rays : 2u << findMSB(rays - 1u); }
uint place_in_walk(uint step, uint length) {
  return length <= sample_part ? step : step * (uint(0.618034 * float(length)) | 1u) & (length - 1u);
}

// Adds the traced rays of a subgroup to their slots, which are few: one addition per slot.
void add_rays(bool traced, uint slot) {
  while (traced) {
    const uint first = subgroupBroadcastFirst(slot);
    if (slot == first) {
      const uint rays = subgroupAdd(1u);
      if (subgroupElect()) add64(push.slot_rays, 2u * first, rays);
      traced = false;
    }
  }
}

#endif
