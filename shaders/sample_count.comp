// SPDX-License-Identifier: Apache-2.0
// Adds what the stages left with each sight of a chunk to counts, masks and rays: a thread a sight. Not before all of
// the chunk has been traced, so that a chunk which did not fit can come again.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/sample_list.glsl"

layout(local_size_x = group_size) in;
layout(push_constant, scalar) uniform Push { SamplePush push; };

void main() {
  const uint k = thread_of_rows();
  const bool known = k < push.control.at[control_sights];
  uint network = 0u, rays = 0u;
  if (known) {
    const SampleSight sight = push.sights.at[k];
    const SampleStation station = push.stations.at[sight.slot];
    network = station.network;
    rays = sight.listed;
    if (sight.points > 0u) {
      atomicAdd(push.counts.at[network * push.voxel_count + sight.voxel], sight.points);
      if (push.mask_words > 0u)
        atomicOr(push.masks.at[(network * push.mask_words + (station.place >> 5)) * push.voxel_count + sight.voxel],
                 1u << (station.place & 31u));
    }
  }
  // Neighbouring sights mostly belong to one network: one addition a subgroup then.
  const uint lowest = subgroupMin(known ? network : 0xFFFFFFFFu), highest = subgroupMax(known ? network : 0u);
  const uint sum = subgroupAdd(rays);
  if (lowest == highest) {
    if (subgroupElect()) add64(push.network_rays, 2u * lowest, sum);
  } else if (known) {
    add64(push.network_rays, 2u * network, rays);
  }
}
