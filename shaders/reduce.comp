// SPDX-License-Identifier: Apache-2.0
// Reduces counts and masks of all voxels to the sums for coverage (equation 8) and overlap (equation 11). Uses only
// integers, so the order does not matter.
//
// Turns masks of reduce_voxels voxels into one bit string per station; then counts pairs 32 voxels at a time.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "lib/references.glsl"

layout(local_size_x = reduce_voxels) in;
layout(push_constant, scalar) uniform Push { ReducePush push; };

const uint words = reduce_voxels / 32u;
// One word of padding after each 32, so that equal positions of the words lie in different banks.
shared uint low[reduce_voxels + words];
shared uint high[reduce_voxels + words];
shared uint seen[64 * words];
shared uint any_seen[reduce_voxels];  // per subgroup
// Weight of saturated voxels, and edges; then 64-bit sums, low word first.
shared uint flags[2];
shared uint sums[6];

// Returns (i, j), i < j, for a pair number, in the order (0, 1), (0, 2), …, (1, 2), …
uvec2 pair_of(uint p, uint n) {
  uint i = 0u;
  while (p >= n - 1u - i) {
    p -= n - 1u - i;
    ++i;
  }
  return uvec2(i, i + 1u + p);
}

uint64_t weighted_points_of(uint voxel, uint count) {
  const bool alike = uint64_t(push.point_weights) == 0ul;
  return count == 0u || alike ? uint64_t(count) : uint64_t(count) * push.point_weights.at[voxel];
}

// Adds to a 64-bit sum of the workgroup.
void add(uint at, uint64_t value) {
  if (value == 0ul) return;
  const uint low = uint(value), before = atomicAdd(sums[at], low);
  const uint high = uint(value >> 32) + (before + low < before ? 1u : 0u);
  if (high > 0u) atomicAdd(sums[at + 1u], high);
}

// Adds a workgroup's sum to the totals.
void publish(uint at, uint sum) {
  add64(push.totals, at, sums[sum]);
  if (sums[sum + 1u] > 0u) atomicAdd(push.totals.at[at + 1u], sums[sum + 1u]);
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
  const bool weighted = uint64_t(push.weights) != 0ul;
  uint saturated = 0u, edges = 0u;
  uint64_t partial = 0ul, squares = 0ul, edge_points = 0ul;
  // Counts of pair thread + reduce_voxels · k; 64 stations have 2016 pairs.
  uint shared_counts[8];
  uint pair_stations[8];
  for (uint k = 0u; k < 8u; ++k) {
    shared_counts[k] = 0u;
    const uint p = thread + reduce_voxels * k;
    const uvec2 pair = p < pairs ? pair_of(p, n) : uvec2(0);
    pair_stations[k] = pair.x | pair.y << 8;
  }
  uint seen_count = 0u;
  if (thread < 2u) flags[thread] = 0u;
  if (thread < 6u) sums[thread] = 0u;

  // All loads come first, so that they are in flight together.
  uint counts_of[reduce_rounds];
  uint some = 0u;  // one bit per round
  [[unroll]] for (uint round = 0u; round < reduce_rounds; ++round) {
    const uint voxel = group + push.groups * ((gl_WorkGroupID.x * reduce_rounds + round) * reduce_voxels + thread);
    counts_of[round] = voxel < push.voxel_count ? push.counts.at[counts + voxel] : 0u;
    if (counts_of[round] > 0u) some |= 1u << round;
  }
  // Skips long stretches of unseen voxels, which are frequent; a voxel without points has no stations.
  const uint some_of_subgroup = subgroupOr(some);
  if (subgroupElect()) any_seen[gl_SubgroupID] = some_of_subgroup;
  barrier();
  uint some_of_all = 0u;
  for (uint g = 0u; g < gl_NumSubgroups; ++g) some_of_all |= any_seen[g];

  // All threads do the same number of rounds, so all reach the barriers.
  [[dont_unroll]] for (uint round = 0u; round < reduce_rounds; ++round) {
    const uint voxel = group + push.groups * ((gl_WorkGroupID.x * reduce_rounds + round) * reduce_voxels + thread);
    const bool inside = voxel < push.voxel_count;
    const uint count = counts_of[round];
    const uint64_t weighted_points = weighted_points_of(voxel, count);
    const bool full = weighted_points >= push.goal;
    const uint weight = !weighted ? 1u : inside ? push.weights.at[voxel / 4u] >> (voxel % 4u * 8u) & 0xFFu : 0u;
    if (inside && full) {
      saturated += weight;
    } else {
      partial += weighted_points * weight;
    }
    if (push.with_differences != 0u && inside && voxel > 0u) {
      const uint64_t before = weighted_points_of(voxel - 1u, push.counts.at[counts + voxel - 1u]);
      const bool full_before = before >= push.goal;
      const uint c = uint(weighted_points >> push.difference_shift), d = uint(before >> push.difference_shift);
      if (full != full_before) {
        const uint partly = full ? d : c;
        ++edges;
        edge_points += partly;
        squares += uint64_t(partly) * partly;
      } else if (!full) {
        const uint step = max(c, d) - min(c, d);
        squares += uint64_t(step) * step;
      }
    }
    if (push.mask_words > 0u && (some_of_all >> round & 1u) != 0u) {
      barrier();
      low[thread + thread / 32u] = count > 0u ? push.masks.at[masks + voxel] : 0u;
      high[thread + thread / 32u] =
          count > 0u && push.mask_words > 1u ? push.masks.at[masks + push.voxel_count + voxel] : 0u;
      barrier();
      for (uint k = thread; k < n * words; k += reduce_voxels) {
        const uint station = k / words, word = k % words;
        uint bits = 0u;
        for (uint v = 0u; v < 32u; ++v) {
          const uint mask = station < 32u ? low[word * 33u + v] : high[word * 33u + v];
          bits |= (mask >> (station & 31u) & 1u) << v;
        }
        seen[k] = bits;
      }
      barrier();
      if (thread < n)
        for (uint w = 0u; w < words; ++w) seen_count += bitCount(seen[thread * words + w]);
      uint k = 0u;
      for (uint p = thread; p < pairs; p += reduce_voxels, ++k) {
        const uvec2 pair = uvec2(pair_stations[k] & 0xFFu, pair_stations[k] >> 8);
        uint both = 0u;
        for (uint w = 0u; w < words; ++w) both += bitCount(seen[pair.x * words + w] & seen[pair.y * words + w]);
        shared_counts[k] += both;
      }
    }
  }

  barrier();
  if (saturated > 0u) atomicAdd(flags[0], saturated);
  if (edges > 0u) atomicAdd(flags[1], edges);
  add(0u, partial);
  add(2u, squares);
  add(4u, edge_points);
  barrier();
  if (thread == 0u) {
    if (flags[0] > 0u) add64(push.totals, totals + totals_saturated, flags[0]);
    if (flags[1] > 0u) atomicAdd(push.totals.at[totals + totals_edges], flags[1]);
    publish(totals + totals_partial, 0u);
    publish(totals + totals_squares, 2u);
    publish(totals + totals_edge_points, 4u);
  }
  if (push.mask_words > 0u) {
    if (thread < n && seen_count > 0u) atomicAdd(push.totals.at[totals + totals_seen + thread], seen_count);
    uint k = 0u;
    for (uint p = thread; p < pairs; p += reduce_voxels, ++k)
      if (shared_counts[k] > 0u) atomicAdd(push.totals.at[totals + totals_seen + n + p], shared_counts[k]);
  }
}
