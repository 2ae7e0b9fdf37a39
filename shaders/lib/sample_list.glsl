// SPDX-License-Identifier: Apache-2.0
// The lists of a chunk of sampled evaluation.
#ifndef VANTAGE_LIB_SAMPLE_LIST
#define VANTAGE_LIB_SAMPLE_LIST
#include "lib/references.glsl"

// Whether there was room for all that the chunk's stages wanted so far.
bool fits(Uints control, uint ray_capacity, uint item_capacity) {
  uint most = 0u;
  for (uint stage = 0u; stage < sample_stages; ++stage) most = max(most, control.at[control_rays + stage]);
  return most <= ray_capacity && control.at[control_items] <= item_capacity;
}

// Adds each thread's `mine` to a control word; where the thread's own part begins. One atomic a subgroup: all its
// threads must come here.
uint reserve(Uints control, uint word, uint mine) {
  const uint before = subgroupExclusiveAdd(mine), all = subgroupAdd(mine);
  uint base = 0u;
  if (subgroupElect() && all > 0u) base = atomicAdd(control.at[word], all);
  return subgroupBroadcastFirst(base) + before;
}

#endif
