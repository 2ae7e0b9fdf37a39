// SPDX-License-Identifier: Apache-2.0
// Reduces counts and masks of all voxels to the sums that coverage (equation 8) and overlap (equation 11) are made of. Integers only, so
// the order does not matter.
//
// Masks of 256 voxels are turned into one bit string a station; pairs are then counted 32 voxels at a time.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/references.glsl"

layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push { ReducePush push; };

const uint words = reduce_voxels / 32u;
shared uint low[reduce_voxels];
shared uint high[reduce_voxels];
shared uint seen[64 * words];
shared uint sums[5];

// min(count / goal, 1) in units of 1 / difference_scale.
int ratio_of(uint count) {
  precise float scaled = float(count) * push.difference_unit;
  return count >= push.goal ? int(difference_scale) : int(scaled + 0.5);
}

// Pair number to (i, j), i < j, in the order (0, 1), (0, 2), …, (1, 2), …
uvec2 pair_of(uint p, uint n) {
  uint i = 0u;
  while (p >= n - 1u - i) {
    p -= n - 1u - i;
    ++i;
  }
  return uvec2(i, i + 1u + p);
}

// Adds low + 2^16 · high to a 64-bit sum.
void add_halves(uint at, uint low_half, uint high_half) {
  if (low_half > 0u) add64(push.totals, at, low_half);
  if (high_half > 0u) {
    add64(push.totals, at, high_half << 16);
    atomicAdd(push.totals.at[at + 1u], high_half >> 16);
  }
}

void main() {
  const uint thread = gl_LocalInvocationIndex;
  const uint group = gl_WorkGroupID.y;
  const uint network = push.first_network + gl_WorkGroupID.z;
  const uint n = push.station_counts.at[network];
  const uint pairs = n * (n - 1u) / 2u;
  const uint counts = gl_WorkGroupID.z * push.voxel_count;
  const uint masks = counts * push.mask_words;
  const uint totals = (network * push.groups + group) * push.totals_stride;
  uint saturated = 0u, partial_low = 0u, partial_high = 0u, difference_low = 0u, difference_high = 0u;
  // Of pair thread + 256 k; 64 stations have 2016 pairs.
  uint shared_counts[8];
  for (int k = 0; k < 8; ++k) shared_counts[k] = 0u;
  uint seen_count = 0u;
  if (thread < 5u) sums[thread] = 0u;

  for (uint round = 0u; round < reduce_rounds; ++round) {  // the same for all threads, so the barriers are met by all
    const uint voxel = group + push.groups * ((gl_WorkGroupID.x * reduce_rounds + round) * reduce_voxels + thread);
    const bool inside = voxel < push.voxel_count;
    const uint count = inside ? push.counts.at[counts + voxel] : 0u;
    if (inside && count >= push.goal) {
      ++saturated;
    } else {
      partial_low += count & 0xFFFFu;  // halves, so that no sum of a workgroup overflows
      partial_high += count >> 16;
    }
    if (push.with_differences != 0u && inside && voxel > 0u) {
      const uint difference = uint(abs(ratio_of(count) - ratio_of(push.counts.at[counts + voxel - 1u])));
      const uint square = difference * difference;
      difference_low += square & 0xFFFFu;
      difference_high += square >> 16;
    }
    if (push.mask_words > 0u) {
      barrier();
      low[thread] = inside ? push.masks.at[masks + voxel] : 0u;
      high[thread] = inside && push.mask_words > 1u ? push.masks.at[masks + push.voxel_count + voxel] : 0u;
      barrier();
      for (uint k = thread; k < n * words; k += 256u) {
        const uint station = k / words, word = k % words;
        uint bits = 0u;
        for (uint v = 0u; v < 32u; ++v) {
          const uint mask = station < 32u ? low[word * 32u + v] : high[word * 32u + v];
          bits |= (mask >> (station & 31u) & 1u) << v;
        }
        seen[k] = bits;
      }
      barrier();
      if (thread < n)
        for (uint w = 0u; w < words; ++w) seen_count += bitCount(seen[thread * words + w]);
      uint k = 0u;
      for (uint p = thread; p < pairs; p += 256u, ++k) {
        const uvec2 pair = pair_of(p, n);
        uint both = 0u;
        for (uint w = 0u; w < words; ++w) both += bitCount(seen[pair.x * words + w] & seen[pair.y * words + w]);
        shared_counts[k] += both;
      }
    }
  }

  barrier();
  if (saturated > 0u) atomicAdd(sums[0], saturated);
  if (partial_low > 0u) atomicAdd(sums[1], partial_low);
  if (partial_high > 0u) atomicAdd(sums[2], partial_high);
  if (difference_low > 0u) atomicAdd(sums[3], difference_low);
  if (difference_high > 0u) atomicAdd(sums[4], difference_high);
  barrier();
  if (thread == 0u) {
    if (sums[0] > 0u) atomicAdd(push.totals.at[totals + totals_saturated], sums[0]);
    add_halves(totals + totals_partial, sums[1], sums[2]);
    add_halves(totals + totals_difference, sums[3], sums[4]);
  }
  if (push.mask_words > 0u) {
    if (thread < n && seen_count > 0u) atomicAdd(push.totals.at[totals + totals_seen + thread], seen_count);
    uint k = 0u;
    for (uint p = thread; p < pairs; p += 256u, ++k)
      if (shared_counts[k] > 0u) atomicAdd(push.totals.at[totals + totals_seen + n + p], shared_counts[k]);
  }
}
