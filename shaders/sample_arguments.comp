// SPDX-License-Identifier: Apache-2.0
// Sizes the next indirect dispatch of a chunk from a control word. One thread.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/references.glsl"

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { SampleArgumentsPush push; };

void main() {
  const uint wanted = push.control.at[push.over];
  // Does not begin work that does not fit; the host cuts the chunk and repeats it.
  const bool fits =
      push.control.at[control_pairs] <= push.pair_capacity && push.control.at[control_rays] <= push.ray_capacity &&
      push.control.at[control_parts] <= push.item_capacity && push.control.at[control_rest] <= push.ray_capacity;
  const uint groups = fits ? (wanted + (group_size - 1u)) / group_size : 0u;
  push.control.at[control_dispatch] = min(groups, groups_in_row);
  push.control.at[control_dispatch + 1u] = (groups + groups_in_row - 1u) / groups_in_row;
  push.control.at[control_dispatch + 2u] = 1u;
}
