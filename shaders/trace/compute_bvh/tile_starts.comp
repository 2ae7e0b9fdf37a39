// SPDX-License-Identifier: Apache-2.0
// Finds the nodes of the BVH at which rays of each listed tile may start: one thread per tile. The rays of a tile leave
// one point in almost the same direction, so that their upper steps down the tree are alike. The tile takes these steps
// once for its 1024 rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/tiles.glsl"
#include "lib/turn.glsl"
#include "lib/widening.glsl"
#include "trace/compute_bvh/nodes.glsl"

layout(local_size_x = group_size) in;
layout(push_constant, scalar) uniform Push { TilePush push; };

// Space on the inner side of four planes through the origin, up to `far`. The planes enclose all rays of a tile: two
// upright ones through its first and last column, and two that touch the cones of its first and last row.
struct Beam {
  vec3 planes[4];
  float far;
};

Beam beam_of(uint tile, float far) {
  const uint row0 = first_row_of(tile), column0 = first_column_of(tile);
  const uint row1 = min(row0 + tile_side, parameters.rows) - 1u,
             column1 = min(column0 + tile_side, parameters.columns) - 1u;
  const vec2 first = vec2(parameters.cos_azimuth.at[column0], parameters.sin_azimuth.at[column0]),
             last = vec2(parameters.cos_azimuth.at[column1], parameters.sin_azimuth.at[column1]);
  Beam beam = Beam(vec3[4](vec3(0), vec3(0), vec3(0), vec3(0)), far);
  // Tiles wider than 120° are not convex enough for planes: everything is inside (0, 0, 0).
  const float spread = length(first + last) * 0.5;  // cosine of half the width
  if (spread < 0.5 || float(column1 - column0) * parameters.azimuth_step > 2.1) return beam;
  const vec2 middle = (first + last) / (2.0 * spread);
  beam.planes[0] = vec3(-first.y, first.x, 0);
  beam.planes[1] = vec3(last.y, -last.x, 0);
  // A ray at zenith θ and horizontal distance ρ has ρ·cos θ0 ≥ z·sin θ0 from row 0 on, and ρ·cos θ1 ≤ z·sin θ1 up to
  // row 1. Its component u along the middle satisfies u ≤ ρ ≤ u / spread.
  const float cos0 = parameters.cos_zenith.at[row0], cos1 = parameters.cos_zenith.at[row1];
  const float wide = 1.00001 / spread;
  beam.planes[2] = vec3(middle * (cos0 > 0.0 ? cos0 * wide : cos0), -parameters.sin_zenith.at[row0]);
  beam.planes[3] = vec3(middle * (cos1 < 0.0 ? -cos1 * wide : -cos1), parameters.sin_zenith.at[row1]);
  return beam;
}

// Returns the distance of the box from the origin; negative if it is outside the beam.
float distance_in(Beam beam, vec3 centre, vec3 half_size) {
  for (uint k = 0u; k < 4u; ++k)
    if (dot(beam.planes[k], centre) + dot(abs(beam.planes[k]), half_size) < 0.0) return -1.0;
  const float near = length(max(abs(centre) - half_size, vec3(0))) * 0.999999;
  return near <= beam.far ? near : -1.0;
}

void main() {
  const uint k = gl_GlobalInvocationID.x;
  if (k >= push.tile_list.at[0]) return;
  const uint tile = push.tile_list.at[1u + k];
  Beam beam = beam_of(tile, min(parameters.max_range, push.tile_far.at[tile]));
  if (turned)
    for (uint p = 0u; p < 4u; ++p) beam.planes[p] = turn_direction(push.turn, beam.planes[p]);
  // Twice the widening of the rays' own boxes of nodes, so that the beam holds all nodes that a ray would enter.
  const float widening = 4.0 * widening_of(push.origin);

  // Nodes that may still be opened, first in first out, and nodes where rays start, nearest first; together at most
  // tile_starts.
  uint waiting[tile_starts];
  TileStart starts[tile_starts];
  uint head = 0u, waiting_count = 1u, start_count = 0u;
  float waiting_near[tile_starts];
  waiting[0] = 0u;
  waiting_near[0] = 0.0;
  while (waiting_count > 0u) {
    const uint at = head++ % tile_starts;
    --waiting_count;
    const uint node = waiting[at];
    const float near = waiting_near[at];
    const uvec4 word0 = bvh_nodes.at[4u * node], word1 = bvh_nodes.at[4u * node + 1u],
                word2 = bvh_nodes.at[4u * node + 2u], word3 = bvh_nodes.at[4u * node + 3u];
    const uint children[2] = uint[2](word0.w, word1.w);
    const float nears[2] = float[2](
        distance_in(beam, uintBitsToFloat(word0.xyz) - push.origin, uintBitsToFloat(word1.xyz) + widening),
        distance_in(beam, uintBitsToFloat(word2.xyz) - push.origin, uintBitsToFloat(word3.xyz) + widening));
    uint inside = 0u, leaves = 0u;
    for (uint c = 0u; c < 2u; ++c)
      if (nears[c] >= 0.0) {
        ++inside;
        if ((children[c] & bvh_leaf_bit) != 0u) ++leaves;
      }
    // The parent tests a leaf's box, so rays start at the parent.
    if (leaves > 0u || start_count + waiting_count + inside > tile_starts) {
      uint place = start_count++;
      for (; place > 0u && starts[place - 1u].near > near; --place) starts[place] = starts[place - 1u];
      starts[place] = TileStart(node, near);
    } else {
      for (uint c = 0u; c < 2u; ++c)
        if (nears[c] >= 0.0) {
          const uint free = (head + waiting_count++) % tile_starts;
          waiting[free] = children[c];
          waiting_near[free] = nears[c];
        }
    }
  }
  for (uint s = 0u; s < tile_starts; ++s)
    TileStarts(push.starts).at[k * tile_starts + s] =
        s < start_count ? starts[s] : TileStart(0u, uintBitsToFloat(0x7F800000u));
}
