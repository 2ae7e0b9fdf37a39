// SPDX-License-Identifier: Apache-2.0
// Parameters of scene, pattern, voxels and noise, common to all kernels. They are a uniform block, which drivers cache;
// reading an array's address from memory before every element would cost as much as the element.
#ifndef VANTAGE_LIB_PARAMETERS
#define VANTAGE_LIB_PARAMETERS
#include "lib/references.glsl"

layout(set = 0, binding = 0, scalar) uniform ParameterBlock { TraceParameters parameters; };

#endif
