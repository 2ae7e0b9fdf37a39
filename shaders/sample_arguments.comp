// SPDX-License-Identifier: Apache-2.0
// Sizes the next indirect dispatch of a chunk: over its sights, its queue or the rays of a stage. One thread.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/sample_list.glsl"

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { SampleArgumentsPush push; };

void main() {
  // What does not fit is not begun, and what was begun of the chunk not counted: the host cuts it and comes back.
  const uint wanted = push.control.at[push.over];
  const bool room = fits(push.control, push.ray_capacity, push.item_capacity);
  const uint groups = room ? (wanted + (group_size - 1u)) / group_size : 0u;
  push.control.at[control_dispatch] = min(groups, groups_in_row);
  push.control.at[control_dispatch + 1u] = (groups + groups_in_row - 1u) / groups_in_row;
  push.control.at[control_dispatch + 2u] = 1u;
}
