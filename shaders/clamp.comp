// SPDX-License-Identifier: Apache-2.0
// Keeps the counts of all voxels from wrapping; runs between dispatches whose rays could add up to 2^32.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/references.glsl"

layout(local_size_x = group_size) in;
layout(push_constant, scalar) uniform Push { ClampPush push; };

void main() {
  const uint i = thread_of_rows();
  if (i < push.voxel_count && push.counts.at[i] > count_limit) push.counts.at[i] = count_limit;
}
