// SPDX-License-Identifier: Apache-2.0
// Keeps the counts of all voxels from wrapping; run between dispatches where their rays could add up to 2^32.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/references.glsl"

layout(local_size_x = 128) in;
layout(push_constant, scalar) uniform Push { ClampPush push; };

void main() {
  // A row of groups is at most 32768 long; the rest lies in y.
  const uint i = (gl_WorkGroupID.y * 32768u + gl_WorkGroupID.x) * 128u + gl_LocalInvocationIndex;
  if (i < push.voxel_count && push.counts.at[i] > count_limit) push.counts.at[i] = count_limit;
}
