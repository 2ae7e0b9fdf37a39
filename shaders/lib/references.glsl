// SPDX-License-Identifier: Apache-2.0
// Arrays in device memory, accessed by address.
#ifndef VANTAGE_LIB_REFERENCES
#define VANTAGE_LIB_REFERENCES
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Floats { float at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Uints { uint at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Vec2s { vec2 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Vec3s { vec3 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Vec4s { vec4 at[]; };
layout(buffer_reference) buffer BrickQuarters;
layout(buffer_reference) buffer Slots;
layout(buffer_reference) buffer Limits;
layout(buffer_reference) buffer TriangleRuns;
layout(buffer_reference) buffer MeshTransforms;
layout(buffer_reference) buffer SampleVoxels;
layout(buffer_reference) buffer SampleStations;
layout(buffer_reference) buffer SampleRays;
layout(buffer_reference) buffer SamplePairs;
layout(buffer_reference) buffer SampleItems;

#include "shared/trace_types.h"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer BrickQuarters { uvec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer Slots { BrickSlot at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Limits { PointLimits at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer TriangleRuns { TriangleRun at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MeshTransforms { MeshTransform at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SampleVoxels { SampleVoxel at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SampleStations { SampleStation at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SampleRays { SampleRay at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SamplePairs { SamplePair at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SampleItems { SampleItem at[]; };

const uint brick_quarters = 5u;  // 16 bytes each, of a VoxelBrick

// True if an array exists; a macro, since glslang cannot overload on reference types.
#define GIVEN(array) (uint64_t(array) != 0ul)

// Returns the index of this thread in a dispatch whose groups lie in rows of groups_in_row.
uint thread_of_rows() {
  return (gl_WorkGroupID.y * groups_in_row + gl_WorkGroupID.x) * group_size + gl_LocalInvocationIndex;
}

// Adds to a 64-bit sum of two words, low first. Additions commute, so their order does not matter.
void add64(Uints sums, uint low, uint value) {
  const uint before = atomicAdd(sums.at[low], value);
  if (before + value < before) atomicAdd(sums.at[low + 1], 1);
}

#endif
